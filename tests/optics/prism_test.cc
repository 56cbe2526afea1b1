// SPDX-License-Identifier: Apache-2.0
#include "optics/prism.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "optics/design.h"
#include "optics/paraxial.h"
#include "optics/power_vector.h"
#include "optics/prism_design.h"

namespace lorgnette {
namespace {

using testing::HasSubstr;

Eigen::Matrix2d Power(double s, double c = 0, double a = 180) {
  return LensFrameMatrix(PowerVectorOf({Diopters(s), Diopters(c), AxisDegrees(a)}));
}

Lens Make(double s, double c = 0, double a = 180) {
  LensOrder order;
  order.rx.sphere = Diopters(s);
  order.rx.cylinder = Diopters(c);
  order.rx.axis = AxisDegrees(a);
  order.diameter_mm = 50;
  return DesignLens(order)->lens;
}

// Published cases 15 to 18 and golden C7.
TEST(Prentice, HasThePublishedPrisms) {
  constexpr double kRounding = 1e-14;
  EXPECT_NEAR(PrenticePrism(Power(8.5), {0, -2}).y(), 1.7, kRounding);  // below OC: base up
  EXPECT_NEAR(PrenticePrism(Power(-3.25), {0, 5}).norm(), 1.625, kRounding);
  EXPECT_NEAR(PrenticePrism(Power(7.75), {4, 0}).norm(), 3.1, kRounding);
  EXPECT_NEAR(PrenticePrism(Power(5, -1.5, 90), {0, -8}).y(), 4.0, kRounding);
  EXPECT_NEAR(PrenticePrism(Power(5, -1.5, 90), {5, 0}).norm(), 1.75, kRounding);
  const Eigen::Vector2d c7 = PrenticePrism(Power(-2.5, 5, 135), {0, -12});
  EXPECT_NEAR(std::abs(c7.x()), 3.0, kRounding);
  EXPECT_NEAR(c7.y(), 0, kRounding);
}

TEST(PrismIn, MirrorsBetweenTheEyes) {
  EXPECT_EQ(PrismInLensFrame(Eye::kRight, 2, 1), Eigen::Vector2d(-2, 1));
  EXPECT_EQ(PrismInLensFrame(Eye::kLeft, 2, 1), Eigen::Vector2d(2, 1));
  EXPECT_EQ(PrismIn(Eye::kRight, {-2, 1}), 2);
}

// Prentice is the derivative of the trace at the optical centre, with the equivalent power.
TEST(PrismAt, HasPrenticeAsItsDerivative) {
  constexpr double kStep_mm = 1e-3;  // the remainder is of third order: 1e-6 relative
  for (const Lens& lens : {Make(-6), Make(5, -2, 30), Make(0, -3, 75)}) {
    const Eigen::Matrix2d power = SystemOf(lens).EquivalentPower();
    for (const Eigen::Vector2d& r : {Eigen::Vector2d(kStep_mm, 0), Eigen::Vector2d(0, -kStep_mm)}) {
      const Eigen::Vector2d exact = *PrismAt(lens, lens.medium.index_d, r);
      EXPECT_LT((exact - PrenticePrism(power, r)).norm(), 1e-6 * kStep_mm);
    }
  }
}

TEST(DecenterForPrism, FindsThePointThatHasIt) {
  for (const Lens& lens : {Make(-6), Make(5, -2, 30), Make(-3, -1.25, 100)}) {
    const Eigen::Vector2d prism(1.2, -0.7);
    const auto r = DecenterForPrism(lens, prism, 12);
    ASSERT_TRUE(r) << r.error().message;
    EXPECT_LT((*PrismAt(lens, lens.medium.index_d, *r) - prism).norm(), kDecentrationTolerance_D);
  }
}

TEST(DecenterForPrism, SaysWhenItCannotAndWhatCould) {
  // A cylinder alone moves no prism along its axis (90: vertical).
  const auto along = DecenterForPrism(Make(0, -3, 90), {0, 1}, 20);
  ASSERT_FALSE(along);
  EXPECT_THAT(along.error().message, HasSubstr("no power in that direction; possible: grind it"));
  EXPECT_TRUE(DecenterForPrism(Make(0, -3, 90), {1, 0}, 20));
  const auto weak = DecenterForPrism(Make(-0.5), {2, 0}, 10);
  ASSERT_FALSE(weak);
  EXPECT_THAT(weak.error().message, HasSubstr("move too far"));
}

TEST(PlanPrism, DecentersWhereItCanAndGrindsWhereItMust) {
  const PrismPlan moved = PlanPrism(Make(-6), {1, 0}, 5);
  EXPECT_GT(moved.reference_point_mm.norm(), 1);
  EXPECT_EQ(moved.ground.norm(), 0);
  const PrismPlan ground = PlanPrism(Make(0), {1, 0}, 5);
  EXPECT_EQ(ground.reference_point_mm.norm(), 0);
  EXPECT_EQ(ground.ground, Eigen::Vector2d(1, 0));
}

// Right -5, left -2 and 10 mm down: Prentice says 5 - 2 = 3 base down more before the right eye.
TEST(SlabOff, GoesOnTheMoreMinusLens) {
  const auto plan = PlanSlabOff(Make(-5), Make(-2), 10);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->eye, Eye::kRight);
  EXPECT_NEAR(plan->prism, 3, 0.15);  // aberration at 10 mm and the equivalent power
  EXPECT_EQ(PlanSlabOff(Make(2), Make(5), 10)->eye, Eye::kRight);
  EXPECT_EQ(PlanSlabOff(Make(-5), Make(-4.5), 10)->prism, 0);
}

// Exact by rays where the pupil is, and the outline lies about that point.
TEST(DesignWithPrism, PutsThePrismBeforeThePupilByDecentration) {
  LensOrder order;
  order.eye = Eye::kLeft;
  order.rx = {Diopters(-5), Diopters(-2),       AxisDegrees(30),
              {},           PrismDiopters(1.5), PrismDiopters(-1)};
  order.diameter_mm = 50;
  const auto made = DesignWithPrism(order, 10);
  ASSERT_TRUE(made) << made.error().message;
  ASSERT_TRUE(made->decentred);
  const Lens& lens = made->design.lens;
  const auto prism = PrismAt(lens, lens.medium.index_d, made->reference_point_mm);
  ASSERT_TRUE(prism);
  EXPECT_LT((*prism - PrismInLensFrame(Eye::kLeft, 1.5, -1)).norm(), 2 * kDecentrationTolerance_D);
  EXPECT_EQ(lens.back_tilt_x, 0);
  Eigen::Vector2d middle(0, 0);
  for (const Eigen::Vector2d& p : made->design.order.contour_mm) middle += p;
  middle /= double(made->design.order.contour_mm.size());
  EXPECT_LT((middle - made->reference_point_mm).norm(), 1e-9);
  // The blank grows by twice the decentration, and the edge with it.
  EXPECT_NEAR(made->design.min_blank_mm, 50 + 2 * made->reference_point_mm.norm() + 2, 1e-3);
  order.rx.prism_in = order.rx.prism_up = PrismDiopters(0);
  EXPECT_GT(made->design.max_edge_thickness_mm, DesignLens(order)->max_edge_thickness_mm + 0.2);
  EXPECT_LT(made->design.min_edge_thickness_mm, DesignLens(order)->min_edge_thickness_mm - 0.2);
}

TEST(DesignWithPrism, GrindsWhatDecentrationCannotGive) {
  LensOrder order;
  order.rx.prism_up = PrismDiopters(2);
  order.diameter_mm = 50;
  for (const double sphere : {0.0, 0.5}) {
    order.rx.sphere = Diopters(sphere);
    const auto made = DesignWithPrism(order, 10);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_FALSE(made->decentred);
    EXPECT_THAT(made->why_ground, HasSubstr(sphere == 0 ? "no power" : "too far"));
    const Lens& lens = made->design.lens;
    EXPECT_NEAR(PrismAt(lens, lens.medium.index_d, {0, 0})->y(), 2, 1e-9);
  }
}

}  // namespace
}  // namespace lorgnette
