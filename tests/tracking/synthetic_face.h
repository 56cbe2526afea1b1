// SPDX-License-Identifier: Apache-2.0
// A made-up face for tests: 468 points with the mirror symmetry of the canonical mesh, eyes where
// people have them, and a camera and poses that look at it.
#pragma once

#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "base/camera.h"
#include "base/units.h"
#include "tracking/canonical_mesh.h"

namespace lorgnette::test {

inline CanonicalMesh SyntheticCanonical() {
  CanonicalMesh c;
  c.mesh.positions.assign(kLandmarks, Eigen::Vector3d::Zero());
  c.mirror.assign(kLandmarks, -1);
  const auto pair = [&](int right, int left, const Eigen::Vector3d& at) {
    c.mesh.positions[std::size_t(right)] = at;
    c.mesh.positions[std::size_t(left)] = {-at.x(), at.y(), at.z()};
    c.mirror[std::size_t(right)] = left;
    c.mirror[std::size_t(left)] = right;
  };
  pair(kRightEye.outer, kLeftEye.outer, {-45, 26, 30});
  pair(kRightEye.inner, kLeftEye.inner, {-19, 26, 36});
  for (std::size_t k = 0; k < 4; ++k) {
    const double x = -40 + 5.0 * double(k);
    pair(kRightEye.upper[k], kLeftEye.upper[k], {x, 31, 38});
    pair(kRightEye.lower[k], kLeftEye.lower[k], {x, 22, 37});
  }
  std::mt19937 random(7);
  std::uniform_real_distribution<double> across(5, 70), up(-90, 80);
  int open = -1;
  for (int i = 0; i < kLandmarks; ++i) {
    if (c.mirror[std::size_t(i)] >= 0) continue;
    if (open < 0) {
      open = i;
      continue;
    }
    const double x = across(random), y = up(random);
    pair(open, i, {-x, y, 60 - 0.012 * x * x - 0.003 * y * y});
    open = -1;
  }
  c.rigid_weight = RigidWeights(c.mesh.positions);
  return c;
}

inline Camera TestCamera() { return {960, 720, 1500, 1500, 480, 360}; }

// Yaw and pitch as the head turns, 600 mm in front of the camera.
inline Eigen::Isometry3d TestPose(double yaw_deg, double pitch_deg = 0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() =
      Eigen::Vector3d(1, -1, -1).asDiagonal() *
      Eigen::AngleAxisd(RadiansFromDegrees(yaw_deg), Eigen::Vector3d::UnitY()).toRotationMatrix() *
      Eigen::AngleAxisd(RadiansFromDegrees(pitch_deg), Eigen::Vector3d::UnitX()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(10, -5, 600);
  return pose;
}

inline double AngleDeg(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return DegreesFromRadians(Eigen::AngleAxisd(Eigen::Matrix3d(a.transpose() * b)).angle());
}

}  // namespace lorgnette::test
