// SPDX-License-Identifier: Apache-2.0
#include "render/paper_shadow.h"

#include <algorithm>
#include <limits>

#include "render/directions.h"

namespace lorgnette {
namespace {

constexpr float kFrameLift_mm = 0.02f;
constexpr float kFaceLift_mm = 0.3f;  // as the baked shadow: smooth normals over flat triangles

void Fill(RayPacket& packet, const Eigen::Vector3f& origin, const Eigen::Matrix3f& basis,
          const std::vector<Eigen::Vector3f>& set, std::size_t first) {
  for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
    const bool valid = first + k < set.size();
    const Eigen::Vector3f d = basis * set[valid ? first + k : first];
    packet.valid[k] = valid;
    packet.ox[k] = origin.x();
    packet.oy[k] = origin.y();
    packet.oz[k] = origin.z();
    packet.near[k] = 0;
    packet.dx[k] = d.x();
    packet.dy[k] = d.y();
    packet.dz[k] = d.z();
    packet.far[k] = std::numeric_limits<float>::infinity();
  }
}

}  // namespace

PaperShadow::PaperShadow(int rays, bool sees_face) : sees_face_(sees_face) {
  for (std::uint32_t seed = 0; seed < kSets; ++seed) sets_.push_back(HemisphereStrata(rays, seed));
}

Eigen::Vector3f PaperShadow::Ratio(const EmbreeScene& scene, const Environment& environment,
                                   const Eigen::Matrix3f& world_from_head,
                                   const SurfacePoint& point, std::uint32_t seed) const {
  const std::vector<Eigen::Vector3f>& set = sets_[seed % kSets];
  const std::size_t packets = (set.size() + RayPacket::kSize - 1) / RayPacket::kSize;
  const Eigen::Matrix3f basis = BasisAbout(point.normal);
  thread_local std::vector<std::uint16_t> by_frame;
  by_frame.assign(packets, 0);
  bool any = false;
  RayPacket packet;
  for (std::size_t p = 0; p < packets; ++p) {
    Fill(packet, point.position + kFrameLift_mm * point.normal, basis, set, p * RayPacket::kSize);
    scene.Occluded16(RaySet::kFrame, packet);
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      if (packet.valid[k] && packet.far[k] < 0) by_frame[p] |= std::uint16_t(1u << k);
    }
    any |= by_frame[p] != 0;
  }
  if (!any) return Eigen::Vector3f::Ones();
  // Light with and without glasses, past the face and as if there were none.
  Eigen::Vector3f without = Eigen::Vector3f::Zero(), with = without;
  Eigen::Vector3f without_face = without, with_face_gone = without;
  int open = 0;
  const Eigen::Matrix3f world_from_local = world_from_head * basis;
  for (std::size_t p = 0; p < packets; ++p) {
    Fill(packet, point.position + kFaceLift_mm * point.normal, basis, set, p * RayPacket::kSize);
    if (sees_face_) scene.Occluded16(RaySet::kHead, packet);
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      if (!packet.valid[k]) continue;
      const Eigen::Vector3f light =
          environment.Radiance(world_from_local * set[p * RayPacket::kSize + k]);
      const bool past_frame = !(by_frame[p] >> k & 1);
      without_face += light;
      if (past_frame) with_face_gone += light;
      if (packet.far[k] < 0) continue;
      ++open;
      without += light;
      if (past_frame) with += light;
    }
  }
  const float weight = WeightOfOpenShare(float(open) / float(set.size()));
  const auto ratio = [](float a, float b) { return b > 0 ? a / b : 1.0f; };
  Eigen::Vector3f result;
  for (int c = 0; c < 3; ++c) {
    result[c] = weight * ratio(with[c], without[c]) +
                (1 - weight) * ratio(with_face_gone[c], without_face[c]);
  }
  return result;
}

}  // namespace lorgnette
