// SPDX-License-Identifier: Apache-2.0
#include "optics/power_vector.h"

#include <Eigen/LU>
#include <cmath>

namespace lorgnette {

PowerVector PowerVectorOf(const SphereCylinder& power) {
  const double half = -0.5 * power.cylinder.value();
  const double twice = 2 * power.axis.radians();
  return {power.sphere.value() - half, half * std::cos(twice), half * std::sin(twice)};
}

SphereCylinder MinusCylinderForm(const PowerVector& power) {
  const double j = std::hypot(power.j0, power.j45);
  if (j == 0) return {Diopters(power.mean), Diopters(0), AxisDegrees(180)};
  const double axis = DegreesFromRadians(0.5 * std::atan2(power.j45, power.j0));
  return {Diopters(power.mean + j), Diopters(-2 * j), AxisDegrees(axis < 0 ? axis + 180 : axis)};
}

SphereCylinder PlusCylinderForm(const PowerVector& power) {
  const SphereCylinder minus = MinusCylinderForm(power);
  return minus.cylinder == Diopters(0) ? minus : Transposed(minus);
}

SphereCylinder Transposed(const SphereCylinder& power) {
  return {power.sphere + power.cylinder, -power.cylinder, AxisDegrees(power.axis.value() + 90)};
}

Eigen::Matrix2d LongMatrix(const PowerVector& power) {
  Eigen::Matrix2d f;
  f << power.mean + power.j0, power.j45, power.j45, power.mean - power.j0;
  return f;
}

Eigen::Matrix2d LensFrameMatrix(const PowerVector& power) {
  return LongMatrix({power.mean, power.j0, -power.j45});
}

PowerVector PowerVectorOfLensFrame(const Eigen::Matrix2d& f) {
  return {0.5 * (f(0, 0) + f(1, 1)), 0.5 * (f(0, 0) - f(1, 1)), -0.5 * (f(0, 1) + f(1, 0))};
}

Eigen::Vector2d LensFrameDirection(AxisDegrees axis) {
  return {-std::cos(axis.radians()), std::sin(axis.radians())};
}

PowerVector VertexCompensated(const PowerVector& power, double toward_eye_mm) {
  const Eigen::Matrix2d f = LongMatrix(power);
  const Eigen::Matrix2d step = Eigen::Matrix2d::Identity() - (toward_eye_mm / 1000) * f;
  const Eigen::Matrix2d moved = f * step.inverse();
  return {0.5 * moved.trace(), 0.5 * (moved(0, 0) - moved(1, 1)),
          0.5 * (moved(0, 1) + moved(1, 0))};
}

}  // namespace lorgnette
