// SPDX-License-Identifier: Apache-2.0
#include "render/face_views.h"

#include <tbb/parallel_for.h>

namespace lorgnette {

FaceViews::FaceViews(const EmbreeScene& scene, const TriangleMesh& face,
                     const DirectionColumns& directions)
    : words_((directions.size() + 63) / 64),
      open_(words_ * face.positions.size(), 0),
      hidden_(open_.size(), 0) {
  tbb::parallel_for(std::size_t(0), face.positions.size(), [&](std::size_t i) {
    const Eigen::Vector3f normal = face.normals[i].cast<float>();
    const Eigen::Vector3f origin = face.positions[i].cast<float>() + kFaceLift_mm * normal;
    ForHemispherePackets(
        directions, origin, normal, [&](std::size_t first, RayPacket& packet, const float*) {
          scene.Occluded16(RaySet::kHead, packet);
          for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
            if (!packet.valid[k]) continue;
            const std::size_t at = first + k;
            (packet.far[k] < 0 ? hidden_ : open_)[i * words_ + at / 64] |= std::uint64_t(1)
                                                                           << (at % 64);
          }
        });
  });
}

}  // namespace lorgnette
