// SPDX-License-Identifier: Apache-2.0
// The skin that glasses rest on, while the rest of the face moves.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "base/mesh.h"
#include "geometry/frame_model.h"

namespace lorgnette {

// Worn glasses stay where the face at rest holds them, and so does the skin below pads, bridge and
// temples: it moves neither into them nor away. A tracked mesh that shifts by a millimetre there
// (the landmarks of a turned head do) would bury a pad or lay a temple bare.
//
// Skin within kHeld_mm of what rests on it does not move, beyond kFree_mm all of its motion is
// kept, and a smooth share between.
inline constexpr double kHeld_mm = 10, kFree_mm = 30;
class FaceMotion {
 public:
  //   face              at rest, head space
  //   frame             as fitted: its contacts, pads and temples are what rests on the skin
  FaceMotion(const TriangleMesh& face, const FrameModel& frame,
             const Eigen::Isometry3d& head_from_frame);

  // The face's vertices of one frame of a clip (head space, as many as the face has), with the
  // motion that the glasses leave them.
  std::vector<Eigen::Vector3f> Held(const std::vector<Eigen::Vector3f>& vertices) const;

 private:
  std::vector<Eigen::Vector3f> rest_;
  std::vector<float> free_;  // share of a vertex' motion that is kept
};

}  // namespace lorgnette
