// SPDX-License-Identifier: Apache-2.0
// From landmarks and crops of a whole clip to camera, personal face and the pose of every frame.
#pragma once

#include <optional>
#include <vector>

#include "tracking/canonical_mesh.h"
#include "tracking/face_follower.h"
#include "tracking/head_track.h"

namespace lorgnette {

// The landmark network turns its points too far with the head: its yaw is this times the true one,
// with this spread between people and pictures (docs/tracking.md).
inline constexpr double kNetworkYawGain = 1.15, kNetworkYawGainSigma = 0.1;

// The head's yaw zero from two readings of the same frames: `texture` is right but for a constant,
// `network` is zero at zero and too large by a common gain. Returns what has to be added to
// `texture`. The gain is fitted, held to kNetworkYawGain. Angles in radians.
// Tested: recovers the constant from readings of a gain of its own.
double YawOffset(const std::vector<double>& texture, const std::vector<double>& network);

struct ClipFit {
  HeadTrack track;
  std::vector<double> confidence;  // of each frame's pose, 0..1
};

// Needs at least one frame with landmarks. Poses are not smoothed, expressions not filled in.
//   known  the calibrated camera; otherwise the focal length is fitted about a typical value
ClipFit FitClip(const std::vector<FollowedFrame>& frames, const CanonicalMesh& canonical, int width,
                int height, double pd_mm, const std::optional<Camera>& known);

}  // namespace lorgnette
