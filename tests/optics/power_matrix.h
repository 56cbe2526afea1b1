// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "base/units.h"

namespace lorgnette::test {

// The power of a sphero-cylinder as a matrix, D, its axis counterclockwise from +x, degrees.
inline Eigen::Matrix2d PowerMatrix(double sphere, double cylinder, double angle_deg) {
  const double a = RadiansFromDegrees(angle_deg);
  const double s = std::sin(a), c = std::cos(a);
  Eigen::Matrix2d m;
  m << sphere + cylinder * s * s, -cylinder * s * c, -cylinder * s * c, sphere + cylinder * c * c;
  return m;
}

}  // namespace lorgnette::test
