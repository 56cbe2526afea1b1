// SPDX-License-Identifier: Apache-2.0
#include "optics/wear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "tests/optics/orders.h"

namespace lorgnette {
namespace {

// C9: -5 -3 x 25, n = 1.6, tilted by 18 degrees about x.
TEST(ThinTilted, HasTheGoldenMatrix) {
  const Eigen::Matrix2d f =
      ThinTilted(LongMatrix(PowerVectorOf({Diopters(-5), Diopters(-3), AxisDegrees(25)})),
                 RadiansFromDegrees(18), 0, 1.6);
  EXPECT_NEAR(f(0, 0), -5.70944766, 5.1e-9);
  EXPECT_NEAR(f(0, 1), 1.24609498, 5.1e-9);
  EXPECT_NEAR(f(1, 1), -8.51102334, 5.1e-9);
}

// Published case 12: +15 D, 10 degrees, with 2n = 3.
TEST(MartinTilted, HasThePublishedPower) {
  const SphereCylinder m =
      MartinTilted(Diopters(15), RadiansFromDegrees(10), 1.5, AxisDegrees(180));
  EXPECT_NEAR(m.sphere.value(), 15.1508, 5.1e-5);
  EXPECT_NEAR(m.cylinder.value(), 0.4711, 5.1e-5);
}

// A lens thinned toward nothing tends to the closed form; 1e-4 mm leaves tau F^2 of some 1e-5 D.
TEST(MeasureWorn, TendsToTheThinClosedForm) {
  constexpr double kThin_mm = 1e-4, kBound_D = 2e-5;
  LensOrder order = test::Order160(-5, -3, 25);
  order.center_thickness_mm = kThin_mm;
  order.base_curve = Diopters(2);
  const LensDesign design = *DesignLens(order);
  WearPosition wear;
  wear.pantoscopic_deg = 18;
  const WornPower worn = *MeasureWorn(design.lens, Eye::kRight, wear);
  const Eigen::Matrix2d f = LongMatrix(worn.power);
  EXPECT_NEAR(f(0, 0), -5.70944766, kBound_D);
  EXPECT_NEAR(f(0, 1), 1.24609498, kBound_D);
  EXPECT_NEAR(f(1, 1), -8.51102334, kBound_D);
}

// Thick plus lenses leave Martin's rule: +15 D, n = 1.5, F1 = 16, t = 8, 10 degrees.
TEST(MeasureWorn, HasTheReferencesThickLens) {
  LensOrder order = test::Order160(15);
  order.medium.index_d = 1.5;
  order.base_curve = Diopters(16);
  order.center_thickness_mm = 8;
  order.diameter_mm = 40;
  WearPosition wear;
  wear.pantoscopic_deg = 10;
  const WornPower worn = *MeasureWorn(DesignLens(order)->lens, Eye::kRight, wear);
  const SphereCylinder form = PlusCylinderForm(worn.power);
  EXPECT_NEAR(form.sphere.value(), 15.090, 5.1e-4);
  EXPECT_NEAR(form.cylinder.value(), 0.372, 5.1e-4);
  EXPECT_NEAR(form.axis.value(), 180, 1e-6);
}

TEST(MeasureWorn, StraightLensGivesItsBackVertexPower) {
  const WornPower worn = *MeasureWorn(DesignLens(test::Order160(-4, -2, 70))->lens, Eye::kLeft, {});
  const PowerVector ordered = PowerVectorOf({Diopters(-4), Diopters(-2), AxisDegrees(70)});
  EXPECT_NEAR(worn.power.mean, ordered.mean, 1e-10);
  EXPECT_NEAR(worn.power.j0, ordered.j0, 1e-10);
  EXPECT_NEAR(worn.power.j45, ordered.j45, 1e-10);
  EXPECT_NEAR(worn.prism_in, 0, 1e-12);
}

// Face form gives plano lenses prism with the base out: 100 tau F1 tan t / (1 - tau F1).
TEST(MeasureWorn, FaceFormGivesBaseOutPrism) {
  LensOrder order = test::Order160(0);
  order.base_curve = Diopters(8);
  order.center_thickness_mm = 2;
  for (const Eye eye : {Eye::kRight, Eye::kLeft}) {
    order.eye = eye;
    WearPosition wear;
    wear.face_form_deg = 15;
    const WornPower worn = *MeasureWorn(DesignLens(order)->lens, eye, wear);
    const double tau_f = 0.002 / 1.6 * 8;
    const double predicted = 100 * tau_f / (1 - tau_f) * std::tan(RadiansFromDegrees(15));
    EXPECT_NEAR(worn.prism_in, -predicted, 0.15 * predicted);  // paraxial in the tilt
    EXPECT_NEAR(worn.prism_up, 0, 1e-12);
  }
}

// OD and OS mirror: axis A to 180 - A, and the sign of the wrap.
TEST(MeasureWorn, MirrorsBetweenTheEyes) {
  const WearPosition wear{9, 12, 13};
  const WornPower right =
      *MeasureWorn(DesignLens(test::Order160(-6, -2, 25))->lens, Eye::kRight, wear);
  const WornPower left =
      *MeasureWorn(DesignLens(test::Order160(-6, -2, 155))->lens, Eye::kLeft, wear);
  EXPECT_NEAR(right.power.mean, left.power.mean, 1e-11);
  EXPECT_NEAR(right.power.j0, left.power.j0, 1e-11);
  EXPECT_NEAR(right.power.j45, -left.power.j45, 1e-11);
  EXPECT_NEAR(right.prism_in, left.prism_in, 1e-11);
  EXPECT_NEAR(right.prism_up, left.prism_up, 1e-11);
}

TEST(CompensateForWear, RestoresThePrescriptionByRays) {
  for (const auto& [s, c, a] :
       {std::tuple{-7.0, -2.0, 30.0}, {5.0, -1.5, 120.0}, {9.0, 0.0, 180.0}, {0.0, -4.0, 45.0}}) {
    LensOrder order = test::Order160(s, c, a);
    const WearPosition wear{10, 8, 11};
    const auto result = CompensateForWear(order, 13, wear);
    ASSERT_TRUE(result) << result.error().message;
    const PowerVector target =
        VertexCompensated(PowerVectorOf({Diopters(s), Diopters(c), AxisDegrees(a)}), 13.0 - 11.0);
    EXPECT_NEAR(result->worn.power.mean, target.mean, kWearTolerance_D);
    EXPECT_NEAR(result->worn.power.j0, target.j0, kWearTolerance_D);
    EXPECT_NEAR(result->worn.power.j45, target.j45, kWearTolerance_D);
    const double gain = std::hypot(result->untouched.power.j0 - target.j0,
                                   result->untouched.power.j45 - target.j45);
    std::cout << s << " " << c << ": uncompensated lens errs by "
              << result->untouched.power.mean - target.mean << " D mean, " << 2 * gain
              << " D cylinder\n";
  }
}

TEST(CompensateForWear, DoesNothingForAStraightLensAtTheSameDistance) {
  const auto result = CompensateForWear(test::Order160(-4, -1, 10), 13, {0, 0, 13});
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->design.order.rx.sphere.value(), -4, 1e-9);
  EXPECT_NEAR(result->design.order.rx.cylinder.value(), -1, 1e-9);
}

TEST(CompensateForWear, RefusesAbsurdTilts) {
  EXPECT_FALSE(CompensateForWear(test::Order160(-4), 13, {60, 0, 13}));
}

}  // namespace
}  // namespace lorgnette
