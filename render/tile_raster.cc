// SPDX-License-Identifier: Apache-2.0
#include "render/tile_raster.h"

#include <algorithm>
#include <cstring>
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

void Rasterise(const Job& job) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const auto area_of = [&](const Side& side, hn::Vec<D> x, hn::Vec<D> y) HWY_ATTR {
    return hn::MulSub(hn::Set(d, side.along_x), hn::Sub(y, hn::Set(d, side.y0)),
                      hn::Mul(hn::Set(d, side.along_y), hn::Sub(x, hn::Set(d, side.x0))));
  };
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
    const float scale = 1 / area;
    const Side sides[3] = {Side(b, c), Side(c, a), Side(a, b)};
    const auto low_z = hn::Set(d, std::min({a.inverse_z, b.inverse_z, c.inverse_z}));
    const auto high_z = hn::Set(d, std::max({a.inverse_z, b.inverse_z, c.inverse_z}));
    const auto za = hn::Set(d, scale * a.inverse_z), zb = hn::Set(d, scale * b.inverse_z),
               zc = hn::Set(d, scale * c.inverse_z);
    for (std::size_t group = 0; group < job.packets; group += kPacket) {
      for (std::uint32_t bits = Meeting(d, job, group, x0, y0, x1, y1); bits != 0;
           bits &= bits - 1) {
        const std::size_t packet = group + std::size_t(__builtin_ctz(bits));
        for (std::size_t k = packet * kPacket; k < (packet + 1) * kPacket; k += hn::Lanes(d)) {
          const auto x = hn::LoadU(d, job.x + k), y = hn::LoadU(d, job.y + k);
          const auto ea = area_of(sides[0], x, y), eb = area_of(sides[1], x, y),
                     ec = area_of(sides[2], x, y);
          const auto zero = hn::Zero(d);
          const auto inside = hn::Or(hn::Ge(hn::Min(hn::Min(ea, eb), ec), zero),
                                     hn::Le(hn::Max(hn::Max(ea, eb), ec), zero));
          const auto z = hn::MulAdd(ea, za, hn::MulAdd(eb, zb, hn::Mul(ec, zc)));
          // Of slivers, whose area is rounded away, it could be anything.
          const auto inverse_z = hn::Min(hn::Max(z, low_z), high_z);
          const auto before = hn::LoadU(d, job.inverse_z + k);
          const auto nearer = hn::And(inside, hn::Gt(inverse_z, before));
          if (hn::AllFalse(d, nearer)) continue;
          hn::StoreU(hn::IfThenElse(nearer, inverse_z, before), d, job.inverse_z + k);
          const auto which = hn::LoadU(du, job.nearest + k);
          hn::StoreU(hn::IfThenElse(hn::RebindMask(du, nearer), hn::Set(du, triangle), which), du,
                     job.nearest + k);
        }
      }
    }
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

// Weights of a triangle's second and third vertex at a position, as they are in space.
std::pair<float, float> Weights(const Job& job, const Eigen::Vector3i& t, float x, float y) {
  const ScreenPoint a = FromCorner(job.points[t[0]], job.corner_x, job.corner_y);
  const ScreenPoint b = FromCorner(job.points[t[1]], job.corner_x, job.corner_y);
  const ScreenPoint c = FromCorner(job.points[t[2]], job.corner_x, job.corner_y);
  const auto area_of = [&](const Side& side) {
    return side.along_x * (y - side.y0) - side.along_y * (x - side.x0);
  };
  const float wa = area_of(Side(b, c)) * a.inverse_z, wb = area_of(Side(c, a)) * b.inverse_z,
              wc = area_of(Side(a, b)) * c.inverse_z;
  const float sum = wa + wb + wc;
  if (sum == 0) return {1.0f / 3, 1.0f / 3};
  const float u = std::clamp(wb / sum, 0.0f, 1.0f);
  return {u, std::clamp(wc / sum, 0.0f, 1 - u)};
}

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
  job.corner_x = float(int(tile) % screen.mask.columns * kTileSide);
  job.corner_y = float(int(tile) / screen.mask.columns * kTileSide);
  job.packets = (n + kPacket - 1) / kPacket;
  const std::size_t filled = job.packets * kPacket;
  x_.resize(filled);
  y_.resize(filled);
  for (std::size_t i = 0; i < filled; ++i) {
    const CameraSample& s = samples[std::min(i, n - 1)];
    x_[i] = s.x - job.corner_x;
    y_[i] = s.y - job.corner_y;
  }
  const std::size_t boxes = (job.packets + kPacket - 1) / kPacket * kPacket;
  constexpr float kEmpty = std::numeric_limits<float>::infinity();
  low_x_.assign(boxes, kEmpty);
  low_y_.assign(boxes, kEmpty);
  high_x_.assign(boxes, -kEmpty);
  high_y_.assign(boxes, -kEmpty);
  for (std::size_t i = 0; i < filled; ++i) {
    const std::size_t packet = i / kPacket;
    low_x_[packet] = std::min(low_x_[packet], x_[i]);
    low_y_[packet] = std::min(low_y_[packet], y_[i]);
    high_x_[packet] = std::max(high_x_[packet], x_[i]);
    high_y_[packet] = std::max(high_y_[packet], y_[i]);
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
  HWY_DYNAMIC_DISPATCH(raster::Rasterise)(job);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t triangle = nearest_[i];
    if (triangle == raster::kNothing) continue;
    const auto [u, v] = raster::Weights(job, mesh.triangles[triangle], x_[i], y_[i]);
    const SceneObject object = mesh.ObjectOf(triangle);
    hits[i] = {object, triangle - std::uint32_t(mesh.FirstOf(object)), 1 / inverse_z_[i], u, v};
  }
}

}  // namespace lorgnette

#endif  // HWY_ONCE
