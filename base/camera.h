// SPDX-License-Identifier: Apache-2.0
// Pinhole camera, OpenCV axes: +x right, +y down, +z forward; pixel centres at .5; no distortion.
#pragma once

#include <Eigen/Core>

namespace lorgnette {

struct Camera {
  int width = 0, height = 0;  // pixels
  double fx = 0, fy = 0;      // focal lengths, pixels
  double cx = 0, cy = 0;      // principal point, pixels

  // Pixel position of a point in camera space (z > 0), and the camera-space direction (z = 1).
  Eigen::Vector2d Project(const Eigen::Vector3d& p) const {
    return {fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy};
  }
  Eigen::Vector3d Direction(double px, double py) const {
    return {(px - cx) / fx, (py - cy) / fy, 1.0};
  }
};

}  // namespace lorgnette
