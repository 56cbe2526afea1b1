// SPDX-License-Identifier: Apache-2.0
#include "render/tile_raster.h"

#include <algorithm>
#include <limits>

#include "render/tile_raster_job.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/tile_raster.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, by Highway's rule.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lorgnette::raster {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kPacket>;

// Bit i: box i of sixteen meets the box.
HWY_INLINE std::uint32_t Meeting(D d, const Job& job, std::size_t first, float x0, float y0,
                                 float x1, float y1) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kPacket; i += hn::Lanes(d)) {
    const std::size_t at = first + i;
    const auto across = hn::And(hn::Le(hn::LoadU(d, job.low_x + at), hn::Set(d, x1)),
                                hn::Ge(hn::LoadU(d, job.high_x + at), hn::Set(d, x0)));
    const auto down = hn::And(hn::Le(hn::LoadU(d, job.low_y + at), hn::Set(d, y1)),
                              hn::Ge(hn::LoadU(d, job.high_y + at), hn::Set(d, y0)));
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, hn::And(across, down), bytes);
    bits |= (std::uint32_t(bytes[0]) | std::uint32_t(bytes[1]) << 8) << i;
  }
  return bits;
}

HWY_INLINE hn::Vec<D> AreaBy(D d, const Side& side, hn::Vec<D> x, hn::Vec<D> y) {
  return hn::MulSub(hn::Set(d, side.along_x), hn::Sub(y, hn::Set(d, side.y0)),
                    hn::Mul(hn::Set(d, side.along_y), hn::Sub(x, hn::Set(d, side.x0))));
}

void Rasterise(const Job& job) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  for (std::size_t i = 0; i < job.list_size; ++i) {
    const std::uint32_t triangle = job.list[i];
    const Eigen::Vector3i& t = job.triangles[triangle];
    const ScreenPoint a = FromCorner(job.points[t[0]], job.corner_x, job.corner_y);
    const ScreenPoint b = FromCorner(job.points[t[1]], job.corner_x, job.corner_y);
    const ScreenPoint c = FromCorner(job.points[t[2]], job.corner_x, job.corner_y);
    const float x0 = std::min({a.x, b.x, c.x}), x1 = std::max({a.x, b.x, c.x});
    const float y0 = std::min({a.y, b.y, c.y}), y1 = std::max({a.y, b.y, c.y});
    const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (area == 0) continue;
    std::uint32_t bits = Meeting(d, job, 0, x0, y0, x1, y1);
    if (bits == 0 && job.packets <= kPacket) continue;
    const float scale = 1 / area;
    const Side sides[3] = {Side(b, c), Side(c, a), Side(a, b)};
    const auto low_z = hn::Set(d, std::min({a.inverse_z, b.inverse_z, c.inverse_z}));
    const auto high_z = hn::Set(d, std::max({a.inverse_z, b.inverse_z, c.inverse_z}));
    const auto za = hn::Set(d, scale * a.inverse_z), zb = hn::Set(d, scale * b.inverse_z),
               zc = hn::Set(d, scale * c.inverse_z);
    for (std::size_t group = 0;;) {
      for (; bits != 0; bits &= bits - 1) {
        const std::size_t packet = group + std::size_t(__builtin_ctz(bits));
        for (std::size_t k = packet * kPacket; k < (packet + 1) * kPacket; k += hn::Lanes(d)) {
          const auto x = hn::LoadU(d, job.x + k), y = hn::LoadU(d, job.y + k);
          const auto ea = AreaBy(d, sides[0], x, y), eb = AreaBy(d, sides[1], x, y),
                     ec = AreaBy(d, sides[2], x, y);
          const auto zero = hn::Zero(d);
          const auto inside = hn::Or(hn::Ge(hn::Min(hn::Min(ea, eb), ec), zero),
                                     hn::Le(hn::Max(hn::Max(ea, eb), ec), zero));
          const auto z = hn::MulAdd(ea, za, hn::MulAdd(eb, zb, hn::Mul(ec, zc)));
          // Of slivers, whose area is rounded away, it could be anything.
          const auto inverse_z = hn::Min(hn::Max(z, low_z), high_z);
          const auto before = hn::LoadU(d, job.inverse_z + k);
          const auto nearer = hn::And(inside, hn::Gt(inverse_z, before));
          hn::StoreU(hn::IfThenElse(nearer, inverse_z, before), d, job.inverse_z + k);
          const auto which = hn::LoadU(du, job.nearest + k);
          hn::StoreU(hn::IfThenElse(hn::RebindMask(du, nearer), hn::Set(du, triangle), which), du,
                     job.nearest + k);
        }
      }
      group += kPacket;
      if (group >= job.packets) break;
      bits = Meeting(d, job, group, x0, y0, x1, y1);
    }
  }
}

// Vertices of triangles relative to the tile's corner, a triangle a lane.
struct Corners {
  hn::Vec<D> x, y, inverse_z;
};
HWY_INLINE Corners Gather(D d, const Job& job, hn::Vec<hn::RebindToSigned<D>> vertex) {
  static_assert(sizeof(ScreenPoint) == 3 * sizeof(float));
  const hn::RebindToSigned<D> di;
  const auto at = hn::Mul(vertex, hn::Set(di, 3));
  const float* points = &job.points->x;
  return {hn::Sub(hn::GatherIndex(d, points, at), hn::Set(d, job.corner_x)),
          hn::Sub(hn::GatherIndex(d, points + 1, at), hn::Set(d, job.corner_y)),
          hn::GatherIndex(d, points + 2, at)};
}

HWY_INLINE hn::Vec<D> AreaBy(D, const Corners& p, const Corners& q, hn::Vec<D> x, hn::Vec<D> y) {
  const auto along_x = hn::Sub(q.x, p.x), along_y = hn::Sub(q.y, p.y);
  return hn::MulSub(along_x, hn::Sub(y, p.y), hn::Mul(along_y, hn::Sub(x, p.x)));
}

// Job::u and v: the sample's weights in space.
void Weigh(const Job& job) {
  const D d;
  const hn::RebindToSigned<D> di;
  static_assert(sizeof(Eigen::Vector3i) == 3 * sizeof(std::int32_t));
  const std::int32_t* corners = job.triangles->data();
  for (std::size_t k = 0; k < job.packets * kPacket; k += hn::Lanes(d)) {
    const auto nearest = hn::LoadU(di, reinterpret_cast<const std::int32_t*>(job.nearest) + k);
    const auto triangle = hn::Mul(hn::Max(nearest, hn::Zero(di)), hn::Set(di, 3));
    const Corners a = Gather(d, job, hn::GatherIndex(di, corners, triangle));
    const Corners b = Gather(d, job, hn::GatherIndex(di, corners + 1, triangle));
    const Corners c = Gather(d, job, hn::GatherIndex(di, corners + 2, triangle));
    const auto x = hn::LoadU(d, job.x + k), y = hn::LoadU(d, job.y + k);
    const auto wa = hn::Mul(AreaBy(d, b, c, x, y), a.inverse_z);
    const auto wb = hn::Mul(AreaBy(d, c, a, x, y), b.inverse_z);
    const auto wc = hn::Mul(AreaBy(d, a, b, x, y), c.inverse_z);
    const auto sum = hn::Add(wa, hn::Add(wb, wc));
    // The middle of a triangle that rounding leaves without an area.
    const auto flat = hn::Eq(sum, hn::Zero(d));
    const auto third = hn::Set(d, 1.0f / 3), zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const auto u = hn::Min(hn::Max(hn::Div(wb, sum), zero), one);
    const auto v = hn::Min(hn::Max(hn::Div(wc, sum), zero), hn::Sub(one, u));
    hn::StoreU(hn::IfThenElse(flat, third, u), d, job.u + k);
    hn::StoreU(hn::IfThenElse(flat, third, v), d, job.v + k);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lorgnette::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace lorgnette {
namespace raster {
namespace {

HWY_EXPORT(Rasterise);
HWY_EXPORT(Weigh);

}  // namespace
}  // namespace raster

void TileRaster::Trace(const VisibleMesh& mesh, const ScreenScene& screen, std::size_t tile,
                       const std::vector<CameraSample>& samples, std::vector<SceneHit>& hits) {
  using raster::kPacket;
  const std::size_t n = samples.size();
  hits.assign(n, SceneHit{});
  const std::uint32_t first = screen.first[tile], end = screen.first[tile + 1];
  if (n == 0 || first == end) return;
  raster::Job job;
  const PixelBox area =
      screen.mask.Area(tile, screen.mask.columns * kTileSide, screen.mask.rows * kTileSide);
  job.corner_x = float(area.x0);
  job.corner_y = float(area.y0);
  job.packets = (n + kPacket - 1) / kPacket;
  const std::size_t filled = job.packets * kPacket;
  for (std::vector<float>* column : {&x_, &y_, &u_, &v_}) column->resize(filled);
  const std::size_t boxes = (job.packets + kPacket - 1) / kPacket * kPacket;
  constexpr float kEmpty = std::numeric_limits<float>::infinity();
  low_x_.assign(boxes, kEmpty);
  low_y_.assign(boxes, kEmpty);
  high_x_.assign(boxes, -kEmpty);
  high_y_.assign(boxes, -kEmpty);
  for (std::size_t packet = 0; packet < job.packets; ++packet) {
    Eigen::Array2f low = Eigen::Array2f::Constant(kEmpty), high = -low;
    for (std::size_t i = packet * kPacket; i < (packet + 1) * kPacket; ++i) {
      const CameraSample& s = samples[std::min(i, n - 1)];
      const Eigen::Array2f at(s.x - job.corner_x, s.y - job.corner_y);
      x_[i] = at.x();
      y_[i] = at.y();
      low = low.min(at);
      high = high.max(at);
    }
    low_x_[packet] = low.x();
    low_y_[packet] = low.y();
    high_x_[packet] = high.x();
    high_y_[packet] = high.y();
  }
  inverse_z_.assign(filled, 0);
  nearest_.assign(filled, raster::kNothing);
  job.points = screen.points.data();
  job.triangles = mesh.triangles.data();
  job.list = screen.triangles.data() + first;
  job.list_size = end - first;
  job.x = x_.data();
  job.y = y_.data();
  job.low_x = low_x_.data();
  job.low_y = low_y_.data();
  job.high_x = high_x_.data();
  job.high_y = high_y_.data();
  job.inverse_z = inverse_z_.data();
  job.nearest = nearest_.data();
  job.u = u_.data();
  job.v = v_.data();
  HWY_DYNAMIC_DISPATCH(raster::Rasterise)(job);
  HWY_DYNAMIC_DISPATCH(raster::Weigh)(job);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t triangle = nearest_[i];
    if (triangle == raster::kNothing) continue;
    const SceneObject object = mesh.ObjectOf(triangle);
    hits[i] = {object, triangle - std::uint32_t(mesh.FirstOf(object)), 1 / inverse_z_[i], u_[i],
               v_[i]};
  }
}

}  // namespace lorgnette

#endif  // HWY_ONCE
