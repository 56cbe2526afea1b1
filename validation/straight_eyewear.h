// SPDX-License-Identifier: Apache-2.0
// The simplest wearer: two lenses on straight axes before a flat face, no frame, the camera before
// the right eye. Head coordinates (geometry/eyewear.h).
#pragma once

#include <Eigen/Geometry>

#include "base/camera.h"
#include "base/mesh.h"
#include "base/result.h"
#include "geometry/eyewear.h"
#include "optics/design.h"

namespace lorgnette::validation {

inline constexpr double kStraightVertex_mm = 14, kStraightHalfPd_mm = 32;

// The order designed and certified for both eyes, cut to an ellipse of 48 x 36 mm, back vertices
// 14 mm before the corneal apices, axes along the head's z.
Result<Eyewear> StraightEyewear(LensOrder order);

// A square of 200 mm that faces +z at depth z_mm, in 2 * cells^2 triangles.
TriangleMesh FlatFace(double z_mm, int cells = 1);

// A camera on the right lens' axis, `camera_mm` from the plane of the corneal apices.
struct StraightView {
  Camera camera;
  Eigen::Isometry3d camera_from_head = Eigen::Isometry3d::Identity();
};
StraightView ViewOnRightAxis(double camera_mm, int size_px, double focal_px);

// To the lens frame (optics/ray.h) from head axes: x runs the other way, and z.
inline Eigen::Vector3d LensFromHeadDirection(const Eigen::Vector3d& d) {
  return {-d.x(), d.y(), -d.z()};
}

}  // namespace lorgnette::validation
