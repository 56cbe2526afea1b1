// SPDX-License-Identifier: Apache-2.0
// Rigid pose of known points from where they appear in one image, by robust Gauss-Newton.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "base/camera.h"

namespace lorgnette {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

// One point: where it is on the head (mm), where it is seen (px), how much it counts (>= 0).
struct PointSighting {
  Eigen::Vector3d head;
  Eigen::Vector2d pixel;
  double weight = 1;
};

// The pose changed by a small motion of the head about its own origin: first a turn by
// motion.head<3>() (radians, camera axes), then a shift by motion.tail<3>() (mm, camera axes).
Eigen::Isometry3d Moved(const Eigen::Isometry3d& camera_from_head, const Vector6d& motion);
// The motion that leads from `from` to `to`: Moved(from, MotionBetween(from, to)) == to.
Vector6d MotionBetween(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

struct PoseFit {
  Eigen::Isometry3d camera_from_head = Eigen::Isometry3d::Identity();
  double rms_px = 0;         // weighted
  double inlier_weight = 0;  // sum of the weights after outliers were weighed down
  // Inverse covariance of the pose in the terms of Moved(), for an error of 1 px a sighting.
  Matrix6d information = Matrix6d::Zero();
};

// Minimises the weighted Cauchy loss of scale `scale_px`, from `guess`. Points behind the camera
// do not count. Tested: recovers an exact pose; a third of outliers shifts it little.
PoseFit FitPose(const Camera& camera, const std::vector<PointSighting>& sightings,
                const Eigen::Isometry3d& guess, double scale_px);

}  // namespace lorgnette
