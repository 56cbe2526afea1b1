// SPDX-License-Identifier: Apache-2.0
#include "base/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lorgnette {
namespace {

TEST(Diopters, OwnTheFactorThousand) {
  // A focal length of 250 mm is 4 D; both divisions are exact in binary64.
  EXPECT_EQ(Diopters::FromPerMm(1.0 / 250.0).value(), 4.0);
  EXPECT_EQ(Diopters(4.0).per_mm(), 1.0 / 250.0);
}

TEST(Diopters, AddScaleAndCompareAsNumbers) {
  const Diopters sphere(-4.25), cylinder(-0.75);
  EXPECT_EQ((sphere + cylinder).value(), -5.0);
  EXPECT_EQ((sphere - cylinder).value(), -3.5);
  EXPECT_EQ((-sphere).value(), 4.25);
  EXPECT_EQ((0.5 * cylinder).value(), -0.375);
  EXPECT_EQ(cylinder * 0.5, 0.5 * cylinder);
  EXPECT_EQ((cylinder / 3.0).value(), -0.25);
  EXPECT_LT(sphere, cylinder);
}

TEST(PrismDiopters, DeviateOneCentimetreAMetre) {
  // 100 tan(deviation) returns the prism; atan and tan each err by at most one unit in the last
  // place near 1, and the factor 100 adds one more rounding: 4 epsilon relative covers the three.
  const double bound = 4 * 2.3e-16;
  for (const double prism : {-20.0, -3.0, 0.0, 0.25, 1.0, 10.0}) {
    const double back = 100 * std::tan(PrismDiopters(prism).deviation());
    EXPECT_NEAR(back, prism, bound * std::abs(prism)) << prism;
  }
}

TEST(AxisDegrees, IsKeptAboveZeroAndUpTo180) {
  EXPECT_EQ(AxisDegrees(0).value(), 180);
  EXPECT_EQ(AxisDegrees(180).value(), 180);
  EXPECT_EQ(AxisDegrees(360).value(), 180);
  EXPECT_EQ(AxisDegrees(190).value(), 10);
  EXPECT_EQ(AxisDegrees(-10).value(), 170);
  EXPECT_EQ(AxisDegrees(-180).value(), 180);
  EXPECT_EQ(AxisDegrees(90).value(), 90);
}

TEST(AxisDegrees, NamesOneMeridianForAnglesAHalfTurnApart) {
  for (int degrees = -720; degrees <= 720; degrees += 5) {
    EXPECT_EQ(AxisDegrees(degrees), AxisDegrees(degrees + 180)) << degrees;
    EXPECT_GT(AxisDegrees(degrees).value(), 0) << degrees;
    EXPECT_LE(AxisDegrees(degrees).value(), 180) << degrees;
  }
}

TEST(Angles, ConvertBothWays) {
  EXPECT_EQ(RadiansFromDegrees(180), kPi);
  EXPECT_EQ(DegreesFromRadians(kPi), 180);
  EXPECT_EQ(AxisDegrees(90).radians(), kPi / 2);
}

}  // namespace
}  // namespace lorgnette
