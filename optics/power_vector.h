// SPDX-License-Identifier: Apache-2.0
// Sphere, cylinder and axis as a power vector and as a 2x2 power matrix: the forms one can add.
//
// The cylinder as written has an axis that jumps and is undefined at zero; (M, J0, J45) and the
// matrices are smooth, so designs and comparisons use them. Source: docs/optics.md, "Powers";
// optics of Long's matrix: F = [M + J0, J45; J45, M - J0] in (viewer's right, up).
#pragma once

#include <Eigen/Core>

#include "base/units.h"

namespace lorgnette {

struct SphereCylinder {
  Diopters sphere, cylinder;
  AxisDegrees axis;  // 180 where the cylinder is 0
};

struct PowerVector {
  double mean = 0;  // S + C/2, D
  double j0 = 0;    // -(C/2) cos 2A, D
  double j45 = 0;   // -(C/2) sin 2A, D
};

PowerVector PowerVectorOf(const SphereCylinder& power);
// Minus-cylinder form; cylinder +0 and axis 180 when j0 = j45 = 0.
SphereCylinder MinusCylinderForm(const PowerVector& power);
SphereCylinder PlusCylinderForm(const PowerVector& power);
// The same lens with the cylinder of the other sign: (S + C, -C, A +- 90).
SphereCylinder Transposed(const SphereCylinder& power);

// Long's matrix in TABO axes (viewer's right, up), and the same in the lens frame (optics/ray.h),
// whose x points the other way: the off-diagonal changes sign. Converting here, once, is what keeps
// the left-handed TABO triad out of everything else.
Eigen::Matrix2d LongMatrix(const PowerVector& power);
Eigen::Matrix2d LensFrameMatrix(const PowerVector& power);
PowerVector PowerVectorOfLensFrame(const Eigen::Matrix2d& power);

// Direction in the lens frame of the TABO meridian `axis`: (-cos A, sin A).
Eigen::Vector2d LensFrameDirection(AxisDegrees axis);

// The correction that at a plane `toward_eye_mm` nearer the eye does what `power` does here, by the
// matrix F (I - d F)^-1: exact for any axis, where shifting S and C as numbers is not.
PowerVector VertexCompensated(const PowerVector& power, double toward_eye_mm);

}  // namespace lorgnette
