// SPDX-License-Identifier: Apache-2.0
#include "optics/focimeter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optics/paraxial.h"

namespace lorgnette {
namespace {

Lens MakeLens(double power, double front, double thickness, double index) {
  const double back = power - front / (1 - thickness / 1000 / index * front);
  Lens lens;
  lens.front = Surface(SphereSurface{front / (1000 * (index - 1))});
  lens.back = Surface(SphereSurface{back / (1000 * (1 - index))});
  lens.center_thickness_mm = thickness;
  lens.medium.index_d = index;
  return lens;
}

TEST(Focimeter, ReadsTheBackVertexPowerThroughASmallPupil) {
  // Zone error grows as the square: 0.026 D at 1 mm for the strongest, hence 2.6e-6 D here.
  for (const Lens& lens : {MakeLens(-6, 2, 1.5, 1.6), MakeLens(10, 12, 5, 1.5),
                           MakeLens(-20, 0.5, 1, 1.67), MakeLens(0, 6, 2, 1.5)}) {
    const double n = lens.medium.index_d;
    const auto reading = ReadBackVertexPower(lens, n, {0, 0}, {0.01, 12});
    ASSERT_TRUE(reading);
    const Eigen::Matrix2d exact = SystemOf(lens, n).BackVertexPower();
    EXPECT_LT((reading->power_D - exact).norm(), 5e-6);
    EXPECT_EQ(reading->prism.norm(), 0);
  }
}

TEST(Focimeter, HasThePublishedZoneErrors) {
  struct Row {
    Lens lens;
    double power, radius, error;
  };
  const Lens minus6 = MakeLens(-6, 2, 1.5, 1.6), minus20 = MakeLens(-20, 0.5, 1.5, 1.67);
  for (const Row& row : {Row{minus6, -6, 1, -0.001}, Row{minus6, -6, 2.5, -0.008},
                         Row{minus6, -6, 4, -0.020}, Row{minus20, -20, 1, -0.026},
                         Row{minus20, -20, 2.5, -0.163}, Row{minus20, -20, 4, -0.425}}) {
    const auto reading =
        ReadBackVertexPower(row.lens, row.lens.medium.index_d, {0, 0}, {row.radius, 12});
    ASSERT_TRUE(reading);
    // Half the last digit printed; and the source may put the pupil on the surface, not on the
    // plane of its vertex, which changes r^2 by twice slope times sag over r: 1.3 per cent at most.
    EXPECT_NEAR(reading->power_D(0, 0) - row.power, row.error,
                0.0005 + 0.014 * std::abs(row.error));
  }
}

TEST(Focimeter, ReadsFrontVertexPowerOfTheLensTurnedRound) {
  const Lens lens = MakeLens(10, 12, 6, 1.5);
  const auto reading = ReadFrontVertexPower(lens, 1.5, {0, 0}, {0.01, 12});
  ASSERT_TRUE(reading);
  EXPECT_LT((reading->power_D - SystemOf(lens, 1.5).FrontVertexPower()).norm(), 5e-6);
}

TEST(Focimeter, ReadsCylinderAndAxisOfAToricLensFromEitherSide) {
  Lens lens = MakeLens(-4, 4, 1.5, 1.6);
  lens.back = Surface(TorusSurface{1 / 54.47, 1 / 74.86, RadiansFromDegrees(120)});
  const auto back = ReadBackVertexPower(lens, 1.6, {0, 0}, {0.01, 12});
  const auto front = ReadFrontVertexPower(lens, 1.6, {0, 0}, {0.01, 12});
  ASSERT_TRUE(back && front);
  EXPECT_LT((back->power_D - SystemOf(lens, 1.6).BackVertexPower()).norm(), 5e-6);
  EXPECT_LT((front->power_D - SystemOf(lens, 1.6).FrontVertexPower()).norm(), 5e-6);
  // The steep meridian of the back lies at 120 deg, so the axis lies at 30: 150 in TABO.
  EXPECT_NEAR(back->power.axis.value(), 150, 1e-4);
}

TEST(Focimeter, ReadsPrenticesPrismOffTheCentre) {
  const Lens lens = MakeLens(-6, 2, 1.5, 1.6);
  const auto reading = ReadBackVertexPower(lens, 1.6, {0, 2}, {2.5, 12});
  ASSERT_TRUE(reading);
  // Base = -F r = 1.2 prism D up; the beam follows the normal, so the angle differs by its cube
  // and by thickness: two per cent.
  EXPECT_NEAR(reading->prism.y(), 1.2, 0.024);
  EXPECT_NEAR(reading->prism.x(), 0, 1e-12);
}

TEST(Focimeter, ReadsTheGroundPrismOfAPlano) {
  Lens lens = MakeLens(0, 0, 4, 1.5);
  const double wedge = 0.04;
  lens.back_tilt_x = wedge;
  const auto reading = ReadBackVertexPower(lens, 1.5, {0, 0});
  ASSERT_TRUE(reading);
  // Normal to the back, the beam meets the front at the wedge angle.
  const double deviation = std::asin(1.5 * std::sin(wedge)) - wedge;
  EXPECT_NEAR(reading->prism.norm(), 100 * std::tan(deviation), 1e-12);
  // Turning the back about +x brings its upper half toward the eye: thicker above, base up.
  EXPECT_GT(reading->prism.y(), 0);
  EXPECT_NEAR(reading->power_D.norm(), 0, 1e-9);
}

TEST(Focimeter, AddIsTheDifferenceOfTwoReadingsOnTheProgressivesSide) {
  Lens lens = MakeLens(0, 5, 2, 1.6);
  lens.front = Surface(ProgressiveSurface(5.0 / 600, 2.0 / 600, 0, 14));
  const auto far = ReadFrontVertexPower(lens, 1.6, {0, 8}, {2.5, 12});
  const auto near = ReadFrontVertexPower(lens, 1.6, {0, -20}, {2.5, 12});
  ASSERT_TRUE(far && near);
  const double add = 0.5 * (near->power_D - far->power_D).trace();
  EXPECT_NEAR(add, 2, 0.12);  // tolerance of the standard for adds to 4 D
}

TEST(Focimeter, LosesNoRayQuietly) {
  EXPECT_FALSE(ReadBackVertexPower(MakeLens(-20, 0.5, 1, 1.5), 1.5, {0, 24.3}, {2.5, 12}));
}

TEST(FocimeterTargetTravel, IsTwoAndAHalfMillimetresADioptreForATwentyDioptreStandard) {
  EXPECT_DOUBLE_EQ(FocimeterTargetTravel(Diopters(1), Diopters(20)), 2.5);
  EXPECT_DOUBLE_EQ(FocimeterTargetTravel(Diopters(-6), Diopters(20)), -15);
}

}  // namespace
}  // namespace lorgnette
