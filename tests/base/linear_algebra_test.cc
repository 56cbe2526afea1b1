// SPDX-License-Identifier: Apache-2.0
#include "base/linear_algebra.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace lorgnette {
namespace {

constexpr double kUlps = 1e-15;

TEST(SymmetricEigenvaluesTest, AreThoseOfARotatedDiagonal) {
  for (const double turn : {0.0, 0.3, 1.2, 2.9}) {
    const Eigen::Matrix2d r = Eigen::Rotation2Dd(turn).toRotationMatrix();
    const Eigen::Matrix2d m = r * Eigen::Vector2d(-3, 0.5).asDiagonal() * r.transpose();
    const Eigen::Vector2d values = SymmetricEigenvalues(m);
    EXPECT_NEAR(values[0], -3, 3 * kUlps);
    EXPECT_NEAR(values[1], 0.5, 3 * kUlps);
  }
}

TEST(SolveSymmetricTest, FindsAKnownSolutionOfNormalEquations) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (const Eigen::Index n : {1, 2, 3, 6, 30}) {
    Eigen::MatrixXd rows(4 * n, n), known(n, 2);
    for (double& v : rows.reshaped()) v = normal(random);
    for (double& v : known.reshaped()) v = normal(random);
    const Eigen::MatrixXd a = rows.transpose() * rows;
    // The square of the rows' condition number, of at most 9 or so.
    EXPECT_LT((SolveSymmetric(a, a * known) - known).norm(),
              9 * double(4 * n) * kUlps * known.norm());
  }
}

TEST(SolveSymmetricTest, SolvesWhatASingularSystemAllows) {
  const Eigen::Matrix2d a{{1, 1}, {1, 1}};
  const Eigen::Vector2d x = SolveSymmetric(a, Eigen::Vector2d(2, 2));
  EXPECT_NEAR(x.sum(), 2, 4 * kUlps);
}

TEST(LeastSquaresTest, FindsAKnownSolutionAndLeavesARemainderAcrossTheColumns) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const Eigen::Index n : {1, 2, 3, 6}) {
    Eigen::MatrixXd a(40, n);
    Eigen::VectorXd known(n), off(40);
    for (double& v : a.reshaped()) v = normal(random);
    for (double& v : known) v = normal(random);
    for (double& v : off) v = normal(random);
    // Columns of random numbers have a condition number of at most 3 or so; 40 additions a sum.
    const double rounding = 3 * 40 * kUlps * a.norm();
    EXPECT_LT((LeastSquares(a, a * known) - known).norm(), rounding);
    const Eigen::VectorXd remainder = a * LeastSquares(a, off) - off;
    EXPECT_LT((a.transpose() * remainder).norm(), rounding * off.norm());
  }
}

TEST(LeastSquaresTest, TakesTheShortestOfManySolutions) {
  // Twice the same column, and one of zeros.
  Eigen::MatrixXd a(5, 4);
  a << 1, 1, 0, 2, 1, 1, 0, -1, 1, 1, 0, 3, 1, 1, 0, 0, 1, 1, 0, 5;
  const Eigen::VectorXd x = LeastSquares(a, a * Eigen::Vector4d(3, 1, 7, -2));
  EXPECT_LT((x - Eigen::Vector4d(2, 2, 0, -2)).norm(), 40 * kUlps);
}

TEST(ShortestTurnTest, TakesOneDirectionToTheOtherAndLeavesTheAxis) {
  const Eigen::Vector3d from(1, 2, -3), to(-4, 0.5, 2);
  const Eigen::Quaterniond turn = ShortestTurn(from, to);
  EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 4 * kUlps);
  const Eigen::Vector3d axis = from.cross(to).normalized();
  EXPECT_LT((turn * axis - axis).norm(), 4 * kUlps);
}

TEST(ShortestTurnTest, OfOppositeAndNearlyOppositeDirections) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  for (const double off : {0.0, 1e-12, 1e-9, 1e-7, 1e-4}) {
    const Eigen::Vector3d to = Eigen::Vector3d(off, 0, -1).normalized();
    const Eigen::Quaterniond turn = ShortestTurn(z, to);
    EXPECT_NEAR(turn.norm(), 1, 1e-7) << off;
    EXPECT_LT((turn * z - to).norm(), 1e-7) << off;
  }
}

}  // namespace
}  // namespace lorgnette
