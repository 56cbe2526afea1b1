// SPDX-License-Identifier: Apache-2.0
#include "render/paper_shadow.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "render/directions.h"
#include "render/visibility.h"

namespace lorgnette {

PaperShadow::PaperShadow(int rays, bool sees_face) : sees_face_(sees_face) {
  for (std::uint32_t seed = 0; seed < kSets; ++seed) {
    const std::vector<Eigen::Vector3f> directions = HemisphereStrata(rays, seed);
    rays_ = directions.size();
    const std::size_t padded = (rays_ + RayPacket::kSize - 1) / RayPacket::kSize * RayPacket::kSize;
    Set set;
    for (std::size_t k = 0; k < padded; ++k) {
      const Eigen::Vector3f& d = directions[std::min(k, rays_ - 1)];
      set.x.push_back(d.x());
      set.y.push_back(d.y());
      set.z.push_back(d.z());
    }
    sets_.push_back(std::move(set));
  }
}

void PaperShadow::Fill(const Set& set, std::size_t first, const Eigen::Vector3f& origin,
                       const Eigen::Matrix3f& basis, RayPacket& packet) const {
  const float *x = set.x.data() + first, *y = set.y.data() + first, *z = set.z.data() + first;
  for (int k = 0; k < RayPacket::kSize; ++k) {
    packet.dx[k] = basis(0, 0) * x[k] + basis(0, 1) * y[k] + basis(0, 2) * z[k];
    packet.dy[k] = basis(1, 0) * x[k] + basis(1, 1) * y[k] + basis(1, 2) * z[k];
    packet.dz[k] = basis(2, 0) * x[k] + basis(2, 1) * y[k] + basis(2, 2) * z[k];
  }
  for (int k = 0; k < RayPacket::kSize; ++k) {
    packet.Choose(k, first + std::size_t(k) < rays_);
    packet.ox[k] = origin.x();
    packet.oy[k] = origin.y();
    packet.oz[k] = origin.z();
    packet.near[k] = 0;
    packet.far[k] = std::numeric_limits<float>::infinity();
  }
}

Eigen::Vector3f PaperShadow::Ratio(const EmbreeScene& scene, const Environment& environment,
                                   const Eigen::Matrix3f& world_from_head,
                                   const SurfacePoint& point, std::uint32_t seed) const {
  const Set& set = sets_[seed % kSets];
  const std::size_t padded = set.x.size(), packets = padded / RayPacket::kSize;
  const Eigen::Matrix3f basis = BasisAbout(point.normal);
  // Rays that something stops, one bit a ray of a packet.
  thread_local std::vector<std::uint16_t> by_frame, by_face;
  by_frame.assign(packets, 0);
  by_face.assign(packets, 0);
  RayPacket packet;
  const auto stopped = [&](RaySet by) {
    std::uint16_t bits = 0;
    scene.Occluded16(by, packet);
    for (int k = 0; k < RayPacket::kSize; ++k) {
      bits |= std::uint16_t(unsigned(packet.valid[k] && packet.far[k] < 0) << k);
    }
    return bits;
  };
  bool any = false;
  for (std::size_t p = 0; p < packets; ++p) {
    Fill(set, p * RayPacket::kSize, point.position + kFrameLift_mm * point.normal, basis, packet);
    by_frame[p] = stopped(RaySet::kFrame);
    any |= by_frame[p] != 0;
  }
  if (!any) return Eigen::Vector3f::Ones();
  std::size_t open = rays_;
  for (std::size_t p = 0; p < packets && sees_face_; ++p) {
    Fill(set, p * RayPacket::kSize, point.position + kFaceLift_mm * point.normal, basis, packet);
    by_face[p] = stopped(RaySet::kHead);
    open -= std::size_t(std::popcount(by_face[p]));
  }
  // Light with and without glasses, past the face and as if there were none.
  const float weight = WeightOfOpenShare(float(open) / float(rays_));
  Eigen::Vector3f without = Eigen::Vector3f::Zero(), with = without;
  Eigen::Vector3f without_face = without, with_face_gone = without;
  const Eigen::Matrix3f world_from_local = world_from_head * basis;
  for (std::size_t i = 0; i < rays_; ++i) {
    const unsigned bit = i % RayPacket::kSize;
    const bool past_frame = !(by_frame[i / RayPacket::kSize] >> bit & 1);
    const bool past_face = !(by_face[i / RayPacket::kSize] >> bit & 1);
    if (!past_face && weight == 1) continue;
    const Eigen::Vector3f light =
        environment.Radiance(world_from_local * Eigen::Vector3f(set.x[i], set.y[i], set.z[i]));
    without_face += light;
    if (past_frame) with_face_gone += light;
    if (!past_face) continue;
    without += light;
    if (past_frame) with += light;
  }
  const auto ratio = [](float a, float b) { return b > 0 ? a / b : 1.0f; };
  Eigen::Vector3f result;
  for (int c = 0; c < 3; ++c) {
    result[c] = weight * ratio(with[c], without[c]);
    if (weight < 1) result[c] += (1 - weight) * ratio(with_face_gone[c], without_face[c]);
  }
  return result;
}

}  // namespace lorgnette
