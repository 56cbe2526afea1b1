// SPDX-License-Identifier: Apache-2.0
#include "base/linear_algebra.h"

#include <cmath>

namespace lorgnette {

Eigen::Vector2d SymmetricEigenvalues(const Eigen::Matrix2d& m) {
  const double mean = 0.5 * (m(0, 0) + m(1, 1));
  const double half = std::hypot(0.5 * (m(0, 0) - m(1, 1)), 0.5 * (m(0, 1) + m(1, 0)));
  return {mean - half, mean + half};
}

Eigen::Quaterniond ShortestTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  // Near opposite directions 1 + cos is all rounding; |a + b| is not.
  const double sum = (a + b).norm();
  if (sum < 1e-8) {
    const Eigen::Vector3d axis = a.unitOrthogonal();
    return {0, axis.x(), axis.y(), axis.z()};
  }
  const Eigen::Vector3d axis = a.cross(b) / sum;
  return {0.5 * sum, axis.x(), axis.y(), axis.z()};
}

}  // namespace lorgnette
