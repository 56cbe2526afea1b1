// SPDX-License-Identifier: Apache-2.0
// The personal face: 468 points in head space, and how head space is tied to them.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "base/camera.h"
#include "tracking/canonical_mesh.h"
#include "tracking/face_landmarker.h"
#include "tracking/pose_fit.h"

namespace lorgnette {

// Corneal apices, the wearer's right and left eye, in the space of `points`.
// Across, midway between the corners of the lids; in height, between the middle of the corners and
// that of the margins; in depth 0.031 of their distance before the margins (docs/tracking.md).
struct Pupils {
  Eigen::Vector3d right, left;
  double distance() const { return (left - right).norm(); }
};
Pupils PupilsOf(const std::vector<Eigen::Vector3d>& points);

// head = scale * rotation * point + shift.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  // The same view of the head, in a world scaled alike.
  Eigen::Isometry3d Rebased(const Eigen::Isometry3d& camera_from_point) const;
  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const {
    return scale * (rotation * p) + shift;
  }
};

// Rotation of the weighted least-squares rigid fit b ~ rotation * a + shift (Kabsch 1976).
Eigen::Matrix3d BestRotation(const std::vector<Eigen::Vector3d>& a,
                             const std::vector<Eigen::Vector3d>& b,
                             const std::vector<double>& weights);

// Takes `points` (any space, canonical topology) to head space: mirror plane x = 0 by the best fit
// of the points to their own mirror image, upright as the canonical face, pupils `pd_mm` apart and
// the origin midway between them.
Similarity HeadFromPoints(const std::vector<Eigen::Vector3d>& points,
                          const CanonicalMesh& canonical, double pd_mm);

// Only size and origin: the pupils `pd_mm` apart, the origin midway between them.
Similarity HeadFromPupils(const Pupils& pupils, double pd_mm);

// The canonical face in head space.
std::vector<Eigen::Vector3d> CanonicalHead(const CanonicalMesh& canonical, double pd_mm);

// Pose of a face of the given points from its landmarks alone: the start of every finer fit.
PoseFit FitLandmarkPose(const Camera& camera, const std::vector<Eigen::Vector3d>& head,
                        const std::vector<double>& weights, const FaceLandmarks& landmarks);

// What the landmarks of a clip say of the face's shape, with the poses known.
//   prior    the points where the landmarks cannot tell; prior_sigma_mm (across, up, depth)
//   frames   null: no face; poses: one a frame
// Frames that look straight at the camera count most, since the landmarks of a turned face slide
// over the skin. Returns the points in the space of `prior`.
std::vector<Eigen::Vector3d> ShapeFromLandmarks(const Camera& camera,
                                                const std::vector<Eigen::Vector3d>& prior,
                                                const Eigen::Vector3d& prior_sigma_mm,
                                                const std::vector<const FaceLandmarks*>& frames,
                                                const std::vector<Eigen::Isometry3d>& poses);

// Shape and poses from landmarks alone, in turn, from the canonical face on. Returns the points in
// head space; `poses` (identity where there is null) come back fitted to them.
std::vector<Eigen::Vector3d> FitFace(const Camera& camera, const CanonicalMesh& canonical,
                                     const std::vector<const FaceLandmarks*>& frames, double pd_mm,
                                     std::vector<Eigen::Isometry3d>& poses);

}  // namespace lorgnette
