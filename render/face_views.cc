// SPDX-License-Identifier: Apache-2.0
#include "render/face_views.h"

namespace lorgnette {

FaceViews::FaceViews(const TriangleMesh& face, std::size_t directions)
    : words_((directions + 63) / 64),
      once_(std::make_unique<std::once_flag[]>(face.positions.size())),
      open_(words_ * face.positions.size(), 0),
      hidden_(open_.size(), 0) {
  for (std::size_t i = 0; i < face.positions.size(); ++i) {
    normals_.push_back(face.normals[i].cast<float>());
    origins_.emplace_back(face.positions[i].cast<float>() + kFaceLift_mm * normals_.back());
  }
}

void FaceViews::Prepare(const EmbreeScene& scene, const DirectionColumns& directions,
                        std::size_t vertex) {
  std::call_once(once_[vertex], [&] {
    ForHemispherePackets(directions, origins_[vertex], normals_[vertex],
                         [&](std::size_t first, RayPacket& packet, const float*) {
                           scene.Occluded16(RaySet::kHead, packet);
                           for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
                             if (!packet.valid[k]) continue;
                             const std::size_t at = first + k;
                             (packet.far[k] < 0 ? hidden_ : open_)[vertex * words_ + at / 64] |=
                                 std::uint64_t(1) << (at % 64);
                           }
                         });
  });
}

}  // namespace lorgnette
