// SPDX-License-Identifier: Apache-2.0
#include "base/linear_algebra.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace lorgnette {

Eigen::Vector2d SymmetricEigenvalues(const Eigen::Matrix2d& m) {
  const double mean = 0.5 * (m(0, 0) + m(1, 1));
  const double half = std::hypot(0.5 * (m(0, 0) - m(1, 1)), 0.5 * (m(0, 1) + m(1, 0)));
  return {mean - half, mean + half};
}

Eigen::MatrixXd SolveSymmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  LG_CHECK_EQ(a.rows(), a.cols());
  LG_CHECK_EQ(a.rows(), b.rows());
  return a.ldlt().solve(b);
}

Eigen::VectorXd LeastSquares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const Eigen::Index n = a.cols(), m = a.rows();
  LG_CHECK_GE(m, n);
  LG_CHECK_EQ(m, b.size());
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  constexpr int kMaxSweeps = 40;  // it converges quadratically: six or so are the rule
  // u = a v, turned in pairs of columns until all of u are across each other.
  Eigen::MatrixXd u = a, v = Eigen::MatrixXd::Identity(n, n);
  const auto turn = [](Eigen::MatrixXd& matrix, Eigen::Index i, Eigen::Index j, double c,
                       double s) {
    for (Eigen::Index k = 0; k < matrix.rows(); ++k) {
      const double x = matrix(k, i), y = matrix(k, j);
      matrix(k, i) = c * x - s * y;
      matrix(k, j) = s * x + c * y;
    }
  };
  bool turned = true;
  for (int sweep = 0; turned && sweep < kMaxSweeps; ++sweep) {
    turned = false;
    for (Eigen::Index i = 0; i + 1 < n; ++i) {
      for (Eigen::Index j = i + 1; j < n; ++j) {
        double ii = 0, jj = 0, ij = 0;
        for (Eigen::Index k = 0; k < m; ++k) {
          ii += u(k, i) * u(k, i);
          jj += u(k, j) * u(k, j);
          ij += u(k, i) * u(k, j);
        }
        if (!(std::abs(ij) > kEpsilon * std::sqrt(ii) * std::sqrt(jj))) continue;
        turned = true;
        const double zeta = (jj - ii) / (2 * ij);
        const double t = std::copysign(1 / (std::abs(zeta) + std::hypot(1, zeta)), zeta);
        const double c = 1 / std::sqrt(1 + t * t);
        turn(u, i, j, c, c * t);
        turn(v, i, j, c, c * t);
      }
    }
  }
  Eigen::VectorXd size2(n), along(n);  // squared singular values; u^T b
  for (Eigen::Index i = 0; i < n; ++i) {
    size2[i] = along[i] = 0;
    for (Eigen::Index k = 0; k < m; ++k) {
      size2[i] += u(k, i) * u(k, i);
      along[i] += u(k, i) * b[k];
    }
  }
  double greatest2 = 0;
  for (const double s2 : size2) greatest2 = std::max(greatest2, s2);
  const double smallest = double(m) * kEpsilon * std::sqrt(greatest2);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!(std::sqrt(size2[i]) > smallest)) continue;
    for (Eigen::Index k = 0; k < n; ++k) x[k] += v(k, i) * (along[i] / size2[i]);
  }
  return x;
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
