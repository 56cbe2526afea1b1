// SPDX-License-Identifier: Apache-2.0
// Packets of 16 rays from one point over the half space above its surface.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/embree_scene.h"

namespace lorgnette {

// How far off the skin rays against the frame start, mm.
inline constexpr float kFrameLift_mm = 0.02f;
// The same against the face: smooth normals rise above the flat triangles.
inline constexpr float kFaceLift_mm = 0.3f;

// Calls visit(first, packet, cosine) for every group of 16 neighbours in `directions` (count a
// multiple of 16) of which any lies above the surface; packet.valid marks those that do, cosine
// holds their dot product with `normal`. Packets come ready to trace from `origin`.
template <typename Visit>
void ForHemispherePackets(const std::vector<Eigen::Vector3f>& directions,
                          const Eigen::Vector3f& origin, const Eigen::Vector3f& normal,
                          Visit&& visit) {
  RayPacket packet;
  float cosine[RayPacket::kSize];
  for (std::size_t first = 0; first < directions.size(); first += RayPacket::kSize) {
    bool any = false;
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      const Eigen::Vector3f& d = directions[first + k];
      cosine[k] = d.dot(normal);
      packet.valid[k] = cosine[k] > 0;
      any |= cosine[k] > 0;
    }
    if (!any) continue;
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      const Eigen::Vector3f& d = directions[first + k];
      packet.Set(k, origin, d);
    }
    visit(first, packet, cosine);
  }
}

}  // namespace lorgnette
