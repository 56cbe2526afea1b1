// SPDX-License-Identifier: Apache-2.0
// The lens as the rotating eye meets it: vergence at the vertex sphere for any direction of gaze.
//
// The eye turns about a centre behind the lens. From there a ray goes out through the lens and
// finds the object ray of that gaze; the pencil of a far (or near) object point then comes forward,
// and its vergence is taken where the gaze crosses the vertex sphere, the sphere about the centre
// of rotation through the back vertex. Axes turn with the eye by Listing's law (a rotation about an
// axis across the primary and the present gaze). Source: docs/measurement.md, "Gaze"; goldens C1,
// C4.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "optics/lens.h"
#include "optics/power_vector.h"
#include "optics/ray.h"

namespace lorgnette {

// Where the eye is, in the lens frame.
struct EyePose {
  Eigen::Vector3d rotation_center{0, 0, 0};  // mm
  double vertex_sphere_mm = 27;              // radius
  // Columns: the eye's own x (wearer's right), y (up) and z (into the head) in primary position.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();

  // Primary gaze along the lens axis, centre `stop_mm` behind the back vertex.
  static EyePose OnAxis(const Lens& lens, double stop_mm = 27);
};

// Gaze direction in the eye's axes: theta from primary (-z), phi from +x toward +y, radians.
// Looking out: (sin theta cos phi, sin theta sin phi, -cos theta).
struct Gaze {
  double theta = 0, phi = 0;
  Eigen::Vector3d Direction() const;
};

struct GazeVergence {
  RayStatus status = RayStatus::kMissesSurface;
  Ray object_ray{{0, 0, 0}, {0, 0, 0}};  // toward the eye, starting on the front surface
  Eigen::Vector3d back_mm{0, 0, 0};      // where the gaze crosses the back surface
  Eigen::Matrix2d vergence_D{{0, 0},
                             {0, 0}};  // at the vertex sphere, in the turned eye's x, y; symmetric
  double sagittal_D = 0;               // across the plane of primary and present gaze
  double tangential_D = 0;             // in that plane
  SphereCylinder power;  // minus-cylinder form of vergence_D, axis in the eye's TABO meridians
};

// object_mm  from the front surface to the object point along the object ray.
GazeVergence EvaluateGaze(const Lens& lens, double index, const EyePose& eye, const Gaze& gaze,
                          double object_mm = std::numeric_limits<double>::infinity());

// What the eye misses: the vergence there against the back vertex power on the axis.
struct GazeErrors {
  double oblique_astigmatism_D = 0;  // T' - S'
  double mean_oblique_D = 0;         // (S' + T') / 2 - mean back vertex power
  PowerVector error;                 // V' - F'v as a power vector: blur of a corrected eye
};
GazeErrors ErrorsOf(const GazeVergence& gaze, const Eigen::Matrix2d& back_vertex_power_D);

// Rotation that takes primary gaze to `direction` about an axis across both (unit, eye's axes).
Eigen::Matrix3d ListingRotation(const Eigen::Vector3d& direction);

}  // namespace lorgnette
