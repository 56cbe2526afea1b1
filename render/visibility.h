// SPDX-License-Identifier: Apache-2.0
// Packets of 16 rays from one point over the half space above its surface.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "render/directions.h"
#include "render/embree_scene.h"

namespace lorgnette {

// How far off the skin rays against the frame start, mm.
inline constexpr float kFrameLift_mm = 0.02f;
// The same against the face: smooth normals rise above the flat triangles.
inline constexpr float kFaceLift_mm = 0.3f;

// Calls visit(first, packet, cosine) for every group of 16 neighbours in `directions` of which any
// lies above the surface; packet.valid marks those that do, cosine holds their dot product with
// `normal`. Packets come ready to trace from `origin`, each time anew.
template <typename Visit>
void ForHemispherePackets(const DirectionColumns& directions, const Eigen::Vector3f& origin,
                          const Eigen::Vector3f& normal, Visit&& visit) {
  RayPacket packet;
  for (std::size_t k = 0; k < RayPacket::kSize; ++k) packet.Set(k, origin, normal);
  alignas(64) float cosine[RayPacket::kSize];
  for (std::size_t first = 0; first < directions.size(); first += RayPacket::kSize) {
    const float *x = directions.x.data() + first, *y = directions.y.data() + first,
                *z = directions.z.data() + first;
    std::int32_t any = 0;
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      cosine[k] = x[k] * normal.x() + (y[k] * normal.y() + z[k] * normal.z());
      packet.Choose(k, cosine[k] > 0);
      any |= packet.valid[k];
    }
    if (any == 0) continue;
    std::copy_n(x, RayPacket::kSize, packet.dx);
    std::copy_n(y, RayPacket::kSize, packet.dy);
    std::copy_n(z, RayPacket::kSize, packet.dz);
    std::fill_n(packet.far, RayPacket::kSize, kEndless);
    visit(first, packet, cosine);
  }
}

}  // namespace lorgnette
