// SPDX-License-Identifier: Apache-2.0
// The poses of a whole clip from the texture of the skin: reference views some degrees apart, every
// frame tied to the nearest of them, points and focal length fitted over the clip.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "base/camera.h"
#include "base/mesh.h"
#include "tracking/face_follower.h"
#include "tracking/texture_anchors.h"

namespace lorgnette {

struct AnchoredClip {
  std::vector<AnchorView> views;  // the first is the most frontal; its pose is the input's
  // One a frame; none: no face, or too little texture found again.
  std::vector<std::optional<PoseFit>> poses;
  double rms_px = 0;  // of the anchors over the key frames; 0 without a fit
};

struct AnchoringInput {
  const std::vector<FollowedFrame>& frames;
  const std::vector<Eigen::Isometry3d>&
      landmark_poses;        // one a frame; where there are no landmarks, unused
  const TriangleMesh& face;  // head space, with normals
  const std::vector<double>& rigid_weight;
};

// Needs at least one frame with landmarks.
//   camera           comes back with the focal length that fits the clip, unless
//   focal_log_sigma  is 0; otherwise the spread allowed about its present value
AnchoredClip AnchorClip(const AnchoringInput& input, double focal_log_sigma, Camera& camera);

}  // namespace lorgnette
