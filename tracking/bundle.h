// SPDX-License-Identifier: Apache-2.0
// Poses, points of skin and the focal length, fitted together to where the points are seen.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "base/camera.h"

namespace lorgnette {

struct BundlePoint {
  Eigen::Vector3d head;   // mm; comes back refined
  Eigen::Vector3d ray;    // unit; along it the point's prior is `sigma_mm` wide, across it is free
  Eigen::Vector3d prior;  // mm
};

struct BundleSighting {
  std::size_t frame = 0, point = 0;
  Eigen::Vector2d pixel;
  double weight = 1;
};

struct BundleOptions {
  double sigma_px = 0.5;          // of a sighting of weight 1; the loss is Cauchy from 2 sigma on
  double sigma_mm = 12;           // of a point along its ray
  double focal_log_sigma = 0.25;  // of the focal length about `focal_prior_px`; 0: held
  double focal_prior_px = 0;      // 0: its present value
  std::size_t fixed_frame = 0;    // its pose is held
  int max_iterations = 25;
};

struct BundleReport {
  bool usable = false;
  double rms_px = 0;  // of all sightings, weighted
};

// Refines all of it in place (Ceres, Schur complement over the points).
// Tested: recovers poses, depths and focal length of an exact scene.
BundleReport FitBundle(const std::vector<BundleSighting>& sightings, const BundleOptions& options,
                       Camera& camera, std::vector<Eigen::Isometry3d>& camera_from_head,
                       std::vector<BundlePoint>& points);

}  // namespace lorgnette
