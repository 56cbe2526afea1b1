// SPDX-License-Identifier: Apache-2.0
#include "render/gathered_shadow.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/units.h"
#include "optics/lens_kernel.h"
#include "render/embree_scene.h"
#include "render/visibility.h"

namespace lorgnette {
namespace {

// Rays start this far off the surface; those below the flat triangle are not followed.
constexpr float kLift_mm = 0.02f;

// Skin that a point sees: nearest vertex, and cosine times solid angle.
struct SkinSeen {
  std::uint32_t vertex;
  float weight;
};

struct PointLight {
  Eigen::Vector3f direct_with{0, 0, 0}, direct_without{0, 0, 0}, skin_without{0, 0, 0};
  std::vector<SkinSeen> skin_with;
  bool touched = false, buried = false;
};

// Rays of one point that may pass a lens.
struct LensRays {
  std::vector<float> columns[6], exit_columns[6], second[6], inside[6], first[6];
  std::vector<float> enter, leave, weight;
  std::vector<std::uint8_t> status;
  std::vector<Eigen::Vector3f> cells;
  void Clear() {
    for (auto& c : columns) c.clear();
    weight.clear();
    cells.clear();
  }
  std::size_t size() const { return weight.size(); }
};

RayArrays<float> View(std::vector<float> (&c)[6], std::size_t n) {
  for (auto& v : c) v.resize(n);
  return {c[0].data(), c[1].data(), c[2].data(), c[3].data(), c[4].data(), c[5].data()};
}

Eigen::Vector3f PassedBy(const LensLook& look, const LensRays& rays, std::size_t k,
                         const Eigen::Vector3f& d_in, const Eigen::Vector3f& d_out) {
  const Eigen::Vector3f p1(rays.first[0][k], rays.first[1][k], rays.first[2][k]);
  const Eigen::Vector3f n1(rays.first[3][k], rays.first[4][k], rays.first[5][k]);
  const Eigen::Vector3f p2(rays.inside[0][k], rays.inside[1][k], rays.inside[2][k]);
  const Eigen::Vector3f n2(rays.second[3][k], rays.second[4][k], rays.second[5][k]);
  Eigen::Vector3f passed = look.back.bare() ? Eigen::Vector3f::Constant(1 - rays.enter[k])
                                            : look.back.FromAir(std::abs(d_in.dot(n1))).passed;
  passed =
      passed.cwiseProduct(look.front.bare() ? Eigen::Vector3f::Constant(1 - rays.leave[k])
                                            : look.front.FromGlass(std::abs(d_out.dot(n2))).passed);
  return passed.cwiseProduct(look.tint.Between(p1.cast<double>(), p2.cast<double>()));
}

// Light through one lens: rays (lens frame) that meet both its surfaces inside the contour go on
// along their refracted direction; those that do not meet the glass keep their own.
void ThroughLens(const GatherScene& scene, std::size_t lens, LensRays& rays, PointLight& out) {
  const std::size_t n = rays.size();
  if (n == 0) return;
  const LensSolid& solid = (*scene.lenses)[lens];
  const LensLook& look = (*scene.looks)[lens];
  const Eigen::Matrix3f head_from_lens = solid.head_from_lens().linear().cast<float>();
  const Eigen::Vector3f lens_in_head = solid.head_from_lens().translation().cast<float>();
  const RayArrays<const float> in{rays.columns[0].data(), rays.columns[1].data(),
                                  rays.columns[2].data(), rays.columns[3].data(),
                                  rays.columns[4].data(), rays.columns[5].data()};
  rays.status.resize(n);
  rays.enter.resize(n);
  rays.leave.resize(n);
  RayArrays<float> first = View(rays.first, n), inside = View(rays.inside, n),
                   second = View(rays.second, n);
  LensBatchOutput<float> trace{View(rays.exit_columns, n), rays.status.data()};
  trace.first = &first;
  trace.inside = &inside;
  trace.second = &second;
  trace.first_reflectance = rays.enter.data();
  trace.second_reflectance = rays.leave.data();
  TraceLensBatch(solid.lens(), solid.lens().medium.index_d, in, n, trace);
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector3f d_in(rays.columns[3][k], rays.columns[4][k], rays.columns[5][k]);
    const bool meets_back =
        solid.contour().Contains(double(rays.first[0][k]), double(rays.first[1][k])) &&
        rays.status[k] != std::uint8_t(RayStatus::kMissesSurface);
    if (!meets_back) {
      out.direct_with += rays.cells[k];
      continue;
    }
    out.touched = true;
    // What leaves by the wall, or not at all, is lost behind the rim.
    if (rays.status[k] != std::uint8_t(RayStatus::kOk) ||
        !solid.contour().Contains(double(rays.inside[0][k]), double(rays.inside[1][k]))) {
      continue;
    }
    const Eigen::Vector3f d_out(rays.exit_columns[3][k], rays.exit_columns[4][k],
                                rays.exit_columns[5][k]);
    const Eigen::Vector3f from(rays.exit_columns[0][k], rays.exit_columns[1][k],
                               rays.exit_columns[2][k]);
    const Eigen::Vector3f direction = head_from_lens * d_out;
    const Eigen::Vector3f start = head_from_lens * from + lens_in_head;
    if (scene.scene.Occluded(RaySet::kAll, start, direction, 0, kEndless)) continue;
    out.direct_with +=
        scene.environment_scale * rays.weight[k] *
        PassedBy(look, rays, k, d_in, d_out)
            .cwiseProduct(scene.environment->Radiance(scene.world_from_head * direction));
  }
}

// Adds an open direction to the rays of the lens that it may meet; false when it meets none.
bool MayMeetLens(const GatherScene& scene, const Eigen::Vector3f& origin,
                 const Eigen::Vector3f& direction, float weight, const Eigen::Vector3f& cell,
                 LensRays (&rays)[2]) {
  for (std::size_t lens = 0; lens < scene.lenses->size() && lens < 2; ++lens) {
    const LensSolid& solid = (*scene.lenses)[lens];
    const Eigen::Vector3f o = solid.lens_from_head().linear().cast<float>() * origin +
                              solid.lens_from_head().translation().cast<float>();
    const Eigen::Vector3f d = solid.lens_from_head().linear().cast<float>() * direction;
    if (!(d.z() < 0)) continue;  // from the eye's side outward
    float t0 = 0, t1 = kEndless;
    for (int k = 0; k < 3; ++k) {
      float a = (float(solid.low()[k]) - o[k]) / d[k], b = (float(solid.high()[k]) - o[k]) / d[k];
      if (a > b) std::swap(a, b);
      t0 = std::max(t0, a);
      t1 = std::min(t1, b);
    }
    if (!(t0 <= t1)) continue;
    for (int k = 0; k < 3; ++k) {
      rays[lens].columns[k].push_back(o[k]);
      rays[lens].columns[k + 3].push_back(d[k]);
    }
    rays[lens].weight.push_back(weight);
    rays[lens].cells.push_back(cell);
    return true;
  }
  return false;
}

PointLight GatherPoint(const GatherScene& scene, const DirectionColumns& columns,
                       const LatticePoint& point) {
  PointLight out;
  const Eigen::Vector3i& own = scene.face.triangles[point.triangle];
  const Eigen::Vector3f a = scene.face.positions[std::size_t(own[0])].cast<float>();
  const Eigen::Vector3f b = scene.face.positions[std::size_t(own[1])].cast<float>();
  const Eigen::Vector3f c = scene.face.positions[std::size_t(own[2])].cast<float>();
  Eigen::Vector3f flat = (b - a).cross(c - a).normalized();
  if (flat.dot(point.normal) < 0) flat = -flat;
  const Eigen::Vector3f origin = point.position + kLift_mm * flat;
  const float solid_angle = float(4 * kPi) / float(scene.directions.size());
  thread_local LensRays lens_rays[2];
  for (LensRays& rays : lens_rays) rays.Clear();
  // The frame first: most points have none above them, and need no more.
  struct Above {
    std::size_t first;
    RayPacket rays;
    std::array<float, RayPacket::kSize> cosine;
  };
  thread_local std::vector<Above> packets;
  packets.clear();
  std::size_t above = 0, by_frame = 0;
  ForHemispherePackets(columns, origin, point.normal,
                       [&](std::size_t first, RayPacket& packet, const float* cosine) {
                         for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
                           if (packet.valid[k] && flat.dot(scene.directions[first + k]) <= 0) {
                             packet.Choose(k, false);
                           }
                         }
                         packets.push_back({first, packet, {}});
                         std::copy_n(cosine, RayPacket::kSize, packets.back().cosine.begin());
                         RayPacket& frame = packets.back().rays;
                         scene.scene.Intersect16(RaySet::kFrame, frame);
                         for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
                           if (!frame.valid[k]) continue;
                           ++above;
                           by_frame += frame.object[k] != SceneObject::kNone;
                         }
                       });
  if (by_frame == 0 && scene.lenses == nullptr) return out;
  for (const Above& at : packets) {
    const RayPacket& frame = at.rays;
    RayPacket head = frame;
    std::fill_n(head.far, RayPacket::kSize, kEndless);
    scene.scene.Intersect16(RaySet::kHead, head);
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      if (!frame.valid[k]) continue;
      const bool skin = head.object[k] != SceneObject::kNone;
      const bool blocked =
          frame.object[k] != SceneObject::kNone && (!skin || frame.far[k] < head.far[k]);
      const float weight = at.cosine[k] * solid_angle;
      if (blocked) {
        out.touched = true;
        const Eigen::Vector3f* corner = &scene.frame_radiance[3 * std::size_t(frame.triangle[k])];
        out.direct_with += weight * ((1 - frame.u[k] - frame.v[k]) * corner[0] +
                                     frame.u[k] * corner[1] + frame.v[k] * corner[2]);
      }
      const Eigen::Vector3f& direction = scene.directions[at.first + k];
      if (!skin) {
        const Eigen::Vector3f cell = at.cosine[k] * scene.light.cells[at.first + k];
        out.direct_without += cell;
        if (blocked) continue;
        if (scene.lenses == nullptr ||
            !MayMeetLens(scene, origin, direction, weight, cell, lens_rays)) {
          out.direct_with += cell;
        }
      } else if (head.object[k] == SceneObject::kFace) {
        const Eigen::Vector3i& t = scene.face.triangles[head.triangle[k]];
        const float w0 = 1 - head.u[k] - head.v[k];
        const int nearest = w0 >= head.u[k] && w0 >= head.v[k] ? 0 : head.u[k] >= head.v[k] ? 1 : 2;
        const auto vertex = std::uint32_t(t[nearest]);
        out.skin_without += weight * scene.face_radiance[vertex];
        if (!blocked) out.skin_with.push_back({vertex, weight});
      }
    }
  }
  if (scene.lenses != nullptr) {
    for (std::size_t lens = 0; lens < scene.lenses->size() && lens < 2; ++lens) {
      ThroughLens(scene, lens, lens_rays[lens], out);
    }
  }
  out.buried = above > 0 && by_frame == above;
  if (!out.touched) out.skin_with = {};
  return out;
}

}  // namespace

GatheredShadow GatheredShadow::Gather(const GatherScene& scene, FaceLattice lattice) {
  GatheredShadow shadow;
  const std::vector<LatticePoint>& points = lattice.points();
  const DirectionColumns columns(scene.directions);
  std::vector<PointLight> lights(points.size());
  tbb::parallel_for(std::size_t(0), points.size(),
                    [&](std::size_t i) { lights[i] = GatherPoint(scene, columns, points[i]); });
  std::vector<bool> touched(points.size());
  // The lattice point that lies on each vertex.
  std::vector<std::uint32_t> point_of(scene.face.positions.size(), 0);
  std::vector<std::uint8_t> has_point(scene.face.positions.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    touched[i] = lights[i].touched;
    const LatticePoint& p = points[i];
    const int corner = p.u == 1 ? 1 : p.v == 1 ? 2 : p.u == 0 && p.v == 0 ? 0 : -1;
    if (corner < 0) continue;
    const auto vertex = std::size_t(scene.face.triangles[p.triangle][corner]);
    point_of[vertex] = std::uint32_t(i);
    has_point[vertex] = 1;
  }
  lattice.Touch(touched);

  shadow.values_.assign(points.size(), Eigen::Vector3f::Ones());
  for (int bounce = 0; bounce < kBounces; ++bounce) {
    // A vertex's light behind glasses, as the last pass knows it.
    std::vector<Eigen::Vector3f> radiance(scene.face.positions.size());
    for (std::size_t v = 0; v < radiance.size(); ++v) {
      Eigen::Vector3f ratio = Eigen::Vector3f::Ones();
      if (has_point[v] && shadow.values_[point_of[v]].x() != FaceLattice::kNoValue) {
        ratio = shadow.values_[point_of[v]];
      }
      radiance[v] = ratio.cwiseProduct(scene.face_radiance[v]);
    }
    tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
      const PointLight& light = lights[i];
      if (!light.touched) return;
      Eigen::Vector3f& value = shadow.values_[i];
      if (light.buried) {
        value.setConstant(FaceLattice::kNoValue);
        return;
      }
      Eigen::Vector3f with = light.direct_with;
      for (const SkinSeen& skin : light.skin_with) with += skin.weight * radiance[skin.vertex];
      const Eigen::Vector3f without = light.direct_without + light.skin_without;
      for (int c = 0; c < 3; ++c) value[c] = without[c] > 0 ? with[c] / without[c] : 1;
    });
  }
  shadow.lattice_ = std::move(lattice);
  return shadow;
}

}  // namespace lorgnette
