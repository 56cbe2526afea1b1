// SPDX-License-Identifier: Apache-2.0
#include "optics/banded_system.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdio>
#include <limits>
#include <random>
#include <utility>

namespace lorgnette {
namespace {

constexpr double kLeastEigenvalue = 1e-3;  // at least, of NormalEquations

// A sum of outer products of short stretches, as normal equations are, and a trace of the identity.
Eigen::MatrixXd NormalEquations(int n, int band, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd a = kLeastEigenvalue * Eigen::MatrixXd::Identity(n, n);
  for (int k = 0; k + band < n; ++k) {
    Eigen::VectorXd row(band + 1);
    for (double& v : row) v = normal(random);
    a.block(k, k, band + 1, band + 1) += row * row.transpose();
  }
  return a;
}

TEST(BandedSystem, SolvesAsTheDenseFactorsDo) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (const auto& [n, band] : {std::pair{1, 0}, {2, 1}, {9, 8}, {40, 3}, {200, 28}}) {
    const Eigen::MatrixXd a = NormalEquations(n, band, random);
    Eigen::VectorXd known(n);
    for (double& v : known) v = normal(random);
    const Eigen::VectorXd right = a * known;
    BandedSystem system(n, band);
    for (int j = 0; j < n; ++j) {
      for (int i = j; i <= std::min(n - 1, j + band); ++i) system(i, j) = a(i, j);
    }
    EXPECT_DOUBLE_EQ(system.MeanDiagonal(), a.diagonal().mean());
    const auto x = system.SolveInPlace(right);
    ASSERT_TRUE(x) << n;
    // Backward stability of a factorisation (Higham, Accuracy and Stability, theorem 10.3): the
    // residual is below 4 n (3 n + 1) u |a| |x|, n the longest sum, which is here band + 1.
    const double sum = band + 1, u = 0.5 * std::numeric_limits<double>::epsilon();
    const double bound = 4 * sum * (3 * sum + 1) * u * a.norm() * x->norm();
    const double residual = (a * *x - right).norm();
    EXPECT_LE(residual, bound) << n << " unknowns, band " << band;
    worst = std::max(worst, residual / bound);
    // The rounding of `right` is below n u |a| |known|, which is no more than another such bound.
    EXPECT_LE((*x - known).norm(), 2 * bound / kLeastEigenvalue) << n << " unknowns, band " << band;
  }
  std::printf("worst residual: %.3g of its bound\n", worst);
}

TEST(BandedSystem, RefusesAMatrixThatIsNotPositiveDefinite) {
  BandedSystem singular(2, 1);
  singular(0, 0) = singular(1, 0) = singular(1, 1) = 1;
  EXPECT_FALSE(singular.SolveInPlace(Eigen::VectorXd::Ones(2)));
  BandedSystem nothing(3, 1);
  EXPECT_FALSE(nothing.SolveInPlace(Eigen::VectorXd::Ones(3)));
}

}  // namespace
}  // namespace lorgnette
