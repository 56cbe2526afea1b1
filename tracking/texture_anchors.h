// SPDX-License-Identifier: Apache-2.0
// Points of skin, chosen in one reference picture and found again in all the others. They tell the
// head's turn without the landmark network, whose points slide over the skin of a turned face.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "base/camera.h"
#include "base/mesh.h"
#include "tracking/crop_store.h"
#include "tracking/patch_match.h"
#include "tracking/pose_fit.h"

namespace lorgnette {

// One point of skin in its reference picture.
struct TextureAnchor {
  Eigen::Vector3d head;    // mm; first on the face mesh, then where the clip's bundle puts it
  Eigen::Vector3d mesh;    // the point of the face mesh
  Eigen::Vector3d normal;  // of the mesh there, unit
  Eigen::Vector3d ray;     // away from the reference camera through the point, head space, unit
  std::array<std::optional<PatchTemplate>, TexturePyramid::kLevels> patches;
};

// A picture of the clip that serves as reference.
struct AnchorView {
  std::size_t frame = 0;
  FaceRegion region;
  Eigen::Isometry3d camera_from_head = Eigen::Isometry3d::Identity();
  std::vector<TextureAnchor> anchors;
};

// An anchor seen in some frame.
struct AnchorSighting {
  std::size_t anchor = 0;
  Eigen::Vector2d pixel;
  double weight = 0;  // 0..1, from the correlation
};

// Chooses anchors in one frame's crop, spread over the part of the face that moves with the skull.
//   rigid_weight  one a vertex of `face`; anchors lie where it is high
AnchorView MakeAnchorView(std::size_t frame, const FaceCrop& crop, const TexturePyramid& texture,
                          const Camera& camera, const Eigen::Isometry3d& camera_from_head,
                          const TriangleMesh& face, const std::vector<double>& rigid_weight);

struct AnchorMatch {
  PoseFit pose;
  std::vector<AnchorSighting> sightings;
};

// How well the pose is known beforehand: from landmarks (coarse level first), or already from
// texture (fine level only).
enum class PoseGuess { kRough, kGood };

// Finds the view's anchors in another frame, from a guess of its pose.
// nullopt when too few are found or agree.
std::optional<AnchorMatch> MatchAnchors(const AnchorView& view, const FaceCrop& crop,
                                        const TexturePyramid& texture, const Camera& camera,
                                        const Eigen::Isometry3d& guess, PoseGuess quality);

}  // namespace lorgnette
