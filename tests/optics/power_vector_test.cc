// SPDX-License-Identifier: Apache-2.0
#include "optics/power_vector.h"

#include <gtest/gtest.h>

namespace lorgnette {
namespace {

constexpr double kRounding_D = 1e-14;

SphereCylinder Rx(double s, double c, double a) {
  return {Diopters(s), Diopters(c), AxisDegrees(a)};
}

void ExpectSame(const PowerVector& a, const PowerVector& b, double bound = kRounding_D) {
  EXPECT_NEAR(a.mean, b.mean, bound);
  EXPECT_NEAR(a.j0, b.j0, bound);
  EXPECT_NEAR(a.j45, b.j45, bound);
}

TEST(PowerVector, RoundTripsThroughBothCylinderForms) {
  for (double axis = 3; axis <= 180; axis += 7) {
    const PowerVector p = PowerVectorOf(Rx(-2.25, -1.75, axis));
    const SphereCylinder minus = MinusCylinderForm(p), plus = PlusCylinderForm(p);
    EXPECT_NEAR(minus.sphere.value(), -2.25, kRounding_D);
    EXPECT_NEAR(minus.cylinder.value(), -1.75, kRounding_D);
    EXPECT_NEAR(minus.axis.value(), axis, 1e-12);
    EXPECT_NEAR(plus.cylinder.value(), 1.75, kRounding_D);
    ExpectSame(PowerVectorOf(plus), p);
  }
}

TEST(PowerVector, TranspositionIsTheSameLens) {
  const SphereCylinder rx = Rx(1.25, -2.5, 35);
  ExpectSame(PowerVectorOf(Transposed(rx)), PowerVectorOf(rx));
  EXPECT_EQ(Transposed(rx).axis, AxisDegrees(125));
}

TEST(PowerVector, AxisZeroIsAxisOneEighty) {
  ExpectSame(PowerVectorOf(Rx(-1, -2, 0)), PowerVectorOf(Rx(-1, -2, 180)), 0);
}

TEST(PowerVector, PrintsOneEightyNotZero) {
  EXPECT_EQ(MinusCylinderForm(PowerVectorOf(Rx(0, -1, 180))).axis.value(), 180);
  EXPECT_EQ(MinusCylinderForm({1, 0, 0}).axis.value(), 180);
}

// Published case 19: +2.00 x 120 and -2.25 x 30 make +2.00 -4.25 x 30.
TEST(PowerVector, CrossedCylindersAdd) {
  const PowerVector a = PowerVectorOf(Rx(0, 2, 120)), b = PowerVectorOf(Rx(0, -2.25, 30));
  const SphereCylinder sum = MinusCylinderForm({a.mean + b.mean, a.j0 + b.j0, a.j45 + b.j45});
  EXPECT_NEAR(sum.sphere.value(), 2, kRounding_D);
  EXPECT_NEAR(sum.cylinder.value(), -4.25, kRounding_D);
  EXPECT_NEAR(sum.axis.value(), 30, 1e-12);
}

// C7: -2.50 +5.00 x 135 is [[0, 2.5], [2.5, 0]] in Long's matrix.
TEST(LongMatrix, HasTheGoldenOffDiagonal) {
  const Eigen::Matrix2d f = LongMatrix(PowerVectorOf(Rx(-2.5, 5, 135)));
  EXPECT_NEAR(f(0, 0), 0, kRounding_D);
  EXPECT_NEAR(f(0, 1), 2.5, kRounding_D);
}

// The meridian along the axis carries the sphere, the one across it sphere plus cylinder.
TEST(LensFrameMatrix, HasThePowersInTheTaboMeridians) {
  for (double axis = 10; axis <= 180; axis += 10) {
    const SphereCylinder rx = Rx(-4, -3, axis);
    const Eigen::Matrix2d f = LensFrameMatrix(PowerVectorOf(rx));
    const Eigen::Vector2d along = LensFrameDirection(rx.axis);
    const Eigen::Vector2d across = LensFrameDirection(AxisDegrees(axis + 90));
    EXPECT_NEAR(along.dot(f * along), -4, kRounding_D);
    EXPECT_NEAR(across.dot(f * across), -7, kRounding_D);
    EXPECT_NEAR(along.dot(f * across), 0, kRounding_D);
    ExpectSame(PowerVectorOfLensFrame(f), PowerVectorOf(rx));
  }
}

// Published cases 6 to 11, per meridian.
TEST(VertexCompensated, HasThePublishedSpheres) {
  const auto moved = [](double power, double from, double to) {
    return VertexCompensated({power, 0, 0}, from - to).mean;
  };
  EXPECT_NEAR(moved(-12, 10, 14), -12.605, 5e-4);
  EXPECT_NEAR(moved(-4, 12, 0), -3.82, 5e-3);
  EXPECT_NEAR(moved(-15, 12, 0), -12.71, 5e-3);
  EXPECT_NEAR(moved(8, 12, 0), 8.85, 5e-3);
  EXPECT_NEAR(moved(10, 20, 0), 12.50, 5e-13);
  EXPECT_NEAR(moved(10, 12, 14), 10 / 1.02, 1e-13);
}

// Each principal meridian moves as a sphere, the axis stays; the cylinder number does neither.
TEST(VertexCompensated, ActsOnMeridiansNotOnTheCylinder) {
  const PowerVector moved = VertexCompensated(PowerVectorOf(Rx(-10, -4, 25)), 13);
  const SphereCylinder form = MinusCylinderForm(moved);
  EXPECT_NEAR(form.sphere.value(), -10 / 1.13, 1e-13);
  EXPECT_NEAR(form.sphere.value() + form.cylinder.value(), -14 / 1.182, 1e-13);
  EXPECT_NEAR(form.axis.value(), 25, 1e-12);
}

TEST(VertexCompensated, IsUndoneByTheWayBack) {
  const PowerVector p = PowerVectorOf(Rx(11, -3, 77));
  ExpectSame(VertexCompensated(VertexCompensated(p, 12), -12), p, 1e-13);
}

}  // namespace
}  // namespace lorgnette
