// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_sheet.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optics/power_vector.h"

namespace lorgnette {
namespace {

// Closed forms of the sheet against each other: a few ulp of numbers up to 1000.
constexpr double kSheetRounding = 1e-11;

LensDesign Designed(double sphere, double cylinder, double axis) {
  LensOrder order;
  order.rx.sphere = Diopters(sphere);
  order.rx.cylinder = Diopters(cylinder);
  order.rx.axis = AxisDegrees(axis);
  order.diameter_mm = 50;
  auto design = DesignLens(order);
  EXPECT_TRUE(design);
  return *std::move(design);
}

TEST(MakeLensSheet, StatesTheOrderedPowersInItsPrincipalMeridians) {
  for (const double axis : {1.0, 37.0, 90.0, 135.0, 180.0}) {
    const LensSheet sheet = MakeLensSheet(Designed(-4.25, -0.75, axis), {});
    EXPECT_NEAR(sheet.back_vertex_power_D.along, -4.25, kSheetRounding) << axis;
    EXPECT_NEAR(sheet.back_vertex_power_D.across, -5.0, kSheetRounding) << axis;
    EXPECT_NEAR(sheet.radii_back_mm.along * sheet.back_power_D.along, 1000 * (1 - 1.498),
                1000 * kSheetRounding)
        << axis;
  }
}

TEST(MakeLensSheet, AddsThePapersErrorToThePapersPower) {
  const LensSheet sheet = MakeLensSheet(Designed(8, -2, 30), {});
  EXPECT_NEAR(sheet.paper_power_D.along + sheet.paper_power_error_D.along,
              sheet.back_vertex_power_D.along, kSheetRounding);
  EXPECT_NEAR(sheet.paper_power_D.across + sheet.paper_power_error_D.across,
              sheet.back_vertex_power_D.across, kSheetRounding);
  EXPECT_GT(sheet.paper_power_error_D.along, 1e-3);  // a steep thick lens: the terms are there
}

TEST(MakeLensSheet, SplitsSpectacleMagnificationIntoShapeAndPower) {
  const LensSheet sheet = MakeLensSheet(Designed(5, -1.5, 70), {});
  EXPECT_NEAR(sheet.shape_factor.along * sheet.power_factor.along,
              sheet.spectacle_magnification.along, kSheetRounding);
  EXPECT_NEAR(sheet.shape_factor.across * sheet.power_factor.across,
              sheet.spectacle_magnification.across, kSheetRounding);
  EXPECT_DOUBLE_EQ(sheet.pupil_mm, 13 + kEntrancePupilDepth_mm);
}

TEST(MakeLensSheet, ExactMagnificationMeetsTheParaxialOneNearTheAxis) {
  const LensDesign design = Designed(-6, 0, 180);
  SheetRequest request;
  request.feature_height_mm = 0.02;
  const LensSheet sheet = MakeLensSheet(design, request);
  ASSERT_TRUE(sheet.observer_magnification_exact);
  // The difference goes with the square of the height: below 1e-3 at 6 mm (reference, C8), so below
  // 1e-3 (0.02 / 6)^2 = 1.1e-8 here.
  EXPECT_NEAR(*sheet.observer_magnification_exact, sheet.observer_magnification_paraxial, 1.2e-8);
  request.feature_height_mm = 6;
  const LensSheet outside = MakeLensSheet(design, request);
  EXPECT_GT(*outside.observer_magnification_exact, outside.observer_magnification_paraxial + 1e-5);
}

TEST(MakeLensSheet, GivesAPlanoSurfaceAnInfiniteRadiusAndAnAfocalLensNoFocus) {
  LensOrder order;
  order.base_curve = Diopters(0);
  order.center_thickness_mm = 2;
  const auto design = DesignLens(order);
  ASSERT_TRUE(design);
  const LensSheet sheet = MakeLensSheet(*design, {});
  EXPECT_TRUE(std::isinf(sheet.radius_front_mm.along));
  EXPECT_FALSE(sheet.cardinal_along);
  EXPECT_EQ(sheet.spectacle_magnification.along, 1);
}

// The extremes of an edge lie in the principal meridians, wherever those lie between the points at
// which the rim is sampled.
TEST(EdgeOver, FindsExtremesBetweenThePointsOfTheRim) {
  for (const double axis : {1.0, 30.7, 89.1, 160.37}) {
    LensOrder order;
    order.rx = {Diopters(-4), Diopters(-3), AxisDegrees(axis), {}, {}, {}};
    order.diameter_mm = 50;
    const auto design = DesignLens(order);
    ASSERT_TRUE(design);
    const Eigen::Vector2d along = 25 * LensFrameDirection(AxisDegrees(axis));
    const double thin = *AxialThickness(design->lens, along.x(), along.y());
    const double thick = *AxialThickness(design->lens, -along.y(), along.x());
    constexpr double kRounding_mm = 1e-13;
    EXPECT_NEAR(design->min_edge_thickness_mm, thin, kRounding_mm) << axis;
    EXPECT_NEAR(design->max_edge_thickness_mm, thick, kRounding_mm) << axis;
  }
}

}  // namespace
}  // namespace lorgnette
