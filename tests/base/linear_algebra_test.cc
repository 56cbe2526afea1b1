// SPDX-License-Identifier: Apache-2.0
#include "base/linear_algebra.h"

#include <gtest/gtest.h>

#include <numbers>

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
