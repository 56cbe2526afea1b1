// SPDX-License-Identifier: Apache-2.0
#include "optics/design.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "optics/base_curve.h"
#include "optics/outline.h"
#include "tests/optics/orders.h"

namespace lorgnette {
namespace {

using testing::HasSubstr;

LensOrder GoldenMinusSix() {
  LensOrder order = test::PowerOrder(-6);
  order.medium = {"1.60", 1.6, 42, 1.30};
  order.base_curve = Diopters(2);
  order.center_thickness_mm = 1.5;
  return order;
}

double BackRadius(const LensDesign& design) { return 1 / design.lens.back.VertexCurvature()(0, 0); }

// C1: r1 = 300, r2 = 74.9647942419027, F2 = -8.00375704445836.
TEST(DesignLens, GivesTheExactBackCurve) {
  const auto design = DesignLens(GoldenMinusSix());
  ASSERT_TRUE(design) << design.error().message;
  EXPECT_NEAR(BackRadius(*design), 74.9647942419027, 1e-11);
  EXPECT_NEAR(design->back_power_axis.value(), -8.00375704445836, 1e-13);
  EXPECT_NEAR(1 / design->lens.front.VertexCurvature()(0, 0), 300, 1e-11);
}

// C5: edges of round lenses, and the mass of the 60 mm one.
TEST(DesignLens, GivesTheGoldenEdgesAndMass) {
  LensOrder order = GoldenMinusSix();
  for (const auto& [diameter, edge] :
       {std::pair{50.0, 4.747977}, {60.0, 6.260804}, {70.0, 8.123445}}) {
    order.diameter_mm = diameter;
    const auto design = DesignLens(order);
    ASSERT_TRUE(design);
    EXPECT_NEAR(design->min_edge_thickness_mm, edge, 5e-7);
    EXPECT_NEAR(design->max_edge_thickness_mm, edge, 5e-7);
  }
  order.diameter_mm = 60;
  EXPECT_NEAR(DesignLens(order)->mass_g, 14.098, 5e-4);

  LensOrder strong = test::PowerOrder(-10);
  strong.medium.index_d = 1.74;
  strong.base_curve = Diopters(1);
  strong.center_thickness_mm = 1.5;
  strong.diameter_mm = 65;
  EXPECT_NEAR(DesignLens(strong)->max_edge_thickness_mm, 9.158094, 5e-7);
}

// C6: centre thickness of plus lenses with a 1 mm edge.
TEST(DesignLens, SolvesTheThicknessOfPlusLenses) {
  struct Case {
    double power, index, front, diameter, thickness;
  };
  for (const Case& c : {Case{4, 1.498, 8, 65, 5.5657796}, Case{6, 1.6, 9, 65, 6.4930561},
                        Case{8, 1.67, 11, 60, 6.5384538}}) {
    LensOrder order = test::PowerOrder(c.power);
    order.medium.index_d = c.index;
    order.base_curve = Diopters(c.front);
    order.diameter_mm = c.diameter;
    const auto design = DesignLens(order);
    ASSERT_TRUE(design) << design.error().message;
    EXPECT_NEAR(design->lens.center_thickness_mm, c.thickness, 5e-8);
    EXPECT_NEAR(design->min_edge_thickness_mm, 1, 1e-11);
  }
}

TEST(DesignLens, KeepsTheLeastCentreOfMinusAndWeakLenses) {
  EXPECT_EQ(DesignLens(test::PowerOrder(-3))->lens.center_thickness_mm, 1.5);
  EXPECT_EQ(DesignLens(test::PowerOrder(0))->lens.center_thickness_mm, 1.5);
  EXPECT_EQ(DesignLens(test::PowerOrder(0.25))->lens.center_thickness_mm, 1.5);
}

// C4's back: r = 74.85911083 along 30 and 54.47089646 along 120 (mathematical angles in the right-
// handed frame; as TABO axes 150 and 60).
TEST(DesignLens, GivesTheGoldenTorusWithEitherGenerator) {
  LensOrder order = test::PowerOrder(-4, -3, 150);
  order.medium.index_d = 1.6;
  order.base_curve = Diopters(4);
  order.center_thickness_mm = 1.5;
  order.diameter_mm = 50;
  const auto across = DesignLens(order);
  order.generator = ToricGenerator::kAlongMinusAxis;
  const auto along = DesignLens(order);
  ASSERT_TRUE(across && along);
  const auto* a = std::get_if<TorusSurface>(&across->lens.back.shape());
  const auto* b = std::get_if<TorusSurface>(&along->lens.back.shape());
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(1 / a->curvature_generator, 54.47089646, 5e-9);
  EXPECT_NEAR(1 / a->curvature_across, 74.85911083, 5e-9);
  EXPECT_NEAR(std::remainder(a->generator_angle - RadiansFromDegrees(120), kPi), 0, 1e-14);
  EXPECT_NEAR(1 / b->curvature_generator, 74.85911083, 5e-9);
  EXPECT_NEAR(std::remainder(b->generator_angle - RadiansFromDegrees(30), kPi), 0, 1e-14);
  EXPECT_NEAR(across->back_power_axis.value(), -1000 * 0.6 / 74.85911083, 1e-8);
}

TEST(DesignLens, GivesTheSameSurfaceForTheTransposedPrescription) {
  const auto minus = DesignLens(test::PowerOrder(1.5, -2.25, 20)),
             plus = DesignLens(test::PowerOrder(-0.75, 2.25, 110));
  ASSERT_TRUE(minus && plus);
  const auto& a = std::get<TorusSurface>(minus->lens.back.shape());
  const auto& b = std::get<TorusSurface>(plus->lens.back.shape());
  EXPECT_NEAR(a.curvature_generator, b.curvature_generator, 1e-17);
  EXPECT_NEAR(a.curvature_across, b.curvature_across, 1e-17);
  EXPECT_NEAR(std::remainder(a.generator_angle - b.generator_angle, kPi), 0, 1e-14);
  EXPECT_NEAR(minus->back_power_axis.value(), plus->back_power_across.value(), 1e-13);
}

TEST(DesignLens, TendsToTheSphereAsTheCylinderVanishes) {
  constexpr double kAtHeight_mm = 20;
  const auto sphere = DesignLens(test::PowerOrder(-5));
  for (double c = 1e-2; c > 1e-14; c /= 100) {
    const auto toric = DesignLens(test::PowerOrder(-5, -c, 37));
    ASSERT_TRUE(toric);
    const double sag = sphere->lens.back.Jet(kAtHeight_mm, 3)->z;
    // dz/dF = h^2 / (2000 (n - 1)) = 0.41 mm/D, and twice that with the sag's steepening.
    EXPECT_NEAR(toric->lens.back.Jet(kAtHeight_mm, 3)->z, sag, 0.9 * c + 1e-14) << c;
  }
}

TEST(DesignLens, CutsToTheContour) {
  LensOrder order = test::PowerOrder(4, -2, 90);
  order.contour_mm = {{-24, -14}, {22, -16}, {25, 15}, {-22, 14}};
  const auto design = DesignLens(order);
  ASSERT_TRUE(design) << design.error().message;
  EXPECT_NEAR(design->min_edge_thickness_mm, 1, 1e-11);
  double least = HUGE_VAL;
  for (const Eigen::Vector2d& p : order.contour_mm) {
    least = std::min(least, *AxialThickness(design->lens, p.x(), p.y()));
  }
  EXPECT_GE(least, design->min_edge_thickness_mm - 1e-12);
  std::reverse(order.contour_mm.begin(), order.contour_mm.end());
  EXPECT_NEAR(DesignLens(order)->mass_g, design->mass_g, 1e-10);
}

TEST(EdgeProfile, FollowsTheRim) {
  const LensDesign design = *DesignLens(test::PowerOrder(-5, -2, 30));
  const Outline outline = Outline::Round(60);
  const std::vector<EdgePoint> profile = EdgeProfile(design.lens, outline);
  ASSERT_EQ(profile.size(), outline.rim().size());
  double least = HUGE_VAL, greatest = 0;
  for (const EdgePoint& p : profile) {
    EXPECT_NEAR(p.at.norm(), 30, 1e-12);
    EXPECT_EQ(p.front_z_mm, design.lens.front.Jet(p.at.x(), p.at.y())->z);
    least = std::min(least, p.thickness_mm);
    greatest = std::max(greatest, p.thickness_mm);
  }
  // The principal meridians lie on points of this rim.
  constexpr double kRounding_mm = 1e-14;
  EXPECT_NEAR(least, design.min_edge_thickness_mm, kRounding_mm);
  EXPECT_NEAR(greatest, design.max_edge_thickness_mm, kRounding_mm);
}

TEST(DesignLens, PlanoIsALensToo) {
  LensOrder order = test::PowerOrder(0);
  order.base_curve = Diopters(0);
  const auto design = DesignLens(order);
  ASSERT_TRUE(design);
  EXPECT_EQ(design->lens.back.VertexCurvature().norm(), 0);
  // A slab of CR-39: pi r^2 t rho.
  EXPECT_NEAR(design->mass_g, kPi * 900 * 1.5 / 1000 * 1.32, 1e-12);
}

TEST(DesignLens, SaysWhatIsImpossibleAndWhatWouldBePossible) {
  LensOrder strong = test::PowerOrder(-20);
  strong.medium.index_d = 1.5;
  strong.base_curve = Diopters(0.5);
  auto design = DesignLens(strong);
  ASSERT_FALSE(design);
  EXPECT_THAT(design.error().message, HasSubstr("back surface of -20.50 D"));
  EXPECT_THAT(design.error().message, HasSubstr("possible: a lens up to 48 mm across"));

  LensOrder knife = test::PowerOrder(6);
  knife.center_thickness_mm = 2;
  design = DesignLens(knife);
  ASSERT_FALSE(design);
  EXPECT_THAT(design.error().message, HasSubstr("the surfaces cross"));
  EXPECT_THAT(design.error().message, HasSubstr("mm at the centre for the least edge of 1 mm"));

  LensOrder thick = test::PowerOrder(20);
  thick.base_curve = Diopters(25);
  thick.center_thickness_mm = 40;
  thick.diameter_mm = 30;
  design = DesignLens(thick);
  ASSERT_FALSE(design);
  EXPECT_THAT(design.error().message, HasSubstr("tau F1"));

  LensOrder air = test::PowerOrder(1);
  air.medium.index_d = 1;
  ASSERT_FALSE(DesignLens(air));
  EXPECT_THAT(DesignLens(air).error().message, HasSubstr("index: got 1"));
}

TEST(DesignLens, ShortRuleKeepsStrongPlusLensesReal) {
  for (double power = 1; power <= 20; power += 1) {
    LensOrder order = test::PowerOrder(power);
    order.medium.index_d = 1.6;
    order.diameter_mm = 55;
    const auto design = DesignLens(order);
    ASSERT_TRUE(design) << power << ": " << design.error().message;
  }
}

// Published case 22: Vogel for +2 -1 and -2 -0.5.
TEST(BaseCurve, FollowsVogel) {
  EXPECT_EQ(VogelBaseCurve(Diopters(1.5)), Diopters(7.5));
  EXPECT_EQ(VogelBaseCurve(Diopters(-2.25)), Diopters(4.875));
  EXPECT_EQ(VogelBaseCurve(Diopters(-30)), Diopters(kFlattestRuleCurve_D));
}

}  // namespace
}  // namespace lorgnette
