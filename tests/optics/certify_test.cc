// SPDX-License-Identifier: Apache-2.0
#include "optics/certify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

#include "optics/outline.h"
#include "optics/pencil.h"
#include "optics/power_vector.h"
#include "optics/tolerances.h"
#include "tests/optics/orders.h"

namespace lorgnette {
namespace {

using testing::HasSubstr;

static_assert(!std::is_default_constructible_v<CertifiedLens>);
static_assert(!std::is_constructible_v<CertifiedLens, LensDesign, Certificate>);

// What the extrapolated pencils leave: truncation of sixth order and rounding, see pencil.h.
constexpr double kPencilPower_D = 2e-9;
constexpr double kStatedError_D = 3e-8;  // what the certificate may claim to know it by

const Measurement& Find(const Certificate& certificate, const std::string& start) {
  for (const Measurement& m : certificate.measurements) {
    if (m.quantity.starts_with(start)) return m;
  }
  ADD_FAILURE() << "no " << start;
  return certificate.measurements.front();
}

TEST(Certify, MeasuresThePowerThatWasOrdered) {
  for (const auto& [s, c, a] : {std::tuple{-6.0, 0.0, 180.0},
                                {-4.25, -0.75, 160.0},
                                {5.0, -2.0, 35.0},
                                {2.0, 3.0, 90.0},
                                {-14.0, -4.0, 10.0},
                                {0.0, 0.0, 180.0},
                                {12.0, 0.0, 180.0}}) {
    const auto design = DesignLens(test::Order160(s, c, a));
    ASSERT_TRUE(design) << design.error().message;
    const auto lens = Certify(*design);
    ASSERT_TRUE(lens) << lens.error().message;
    const Certificate& certificate = lens->certificate();
    EXPECT_TRUE(certificate.passed());
    for (const Measurement& m : certificate.measurements) {
      if (m.unit != "D") continue;
      EXPECT_NEAR(m.measured, m.ordered, kPencilPower_D) << m.quantity << " of " << s << " " << c;
      EXPECT_LT(m.numerical_error, kStatedError_D) << m.quantity;
      EXPECT_LE(std::abs(m.measured - m.ordered), m.numerical_error + 1e-13) << m.quantity;
    }
    if (c != 0) {
      EXPECT_NEAR(Find(certificate, "axis").measured, a, 1e-7);
    }
  }
}

// C3: the observer's magnification of three lenses (the golden depth 15.05 is a vertex distance of
// 12 and a pupil at 3.05 mm).
TEST(Certify, MeasuresTheGoldenMagnification) {
  LensOrder minus = test::Order160(-6);
  minus.base_curve = Diopters(2);
  minus.center_thickness_mm = 1.5;
  minus.vertex_distance_mm = 12;
  LensOrder plus = test::Order160(6);
  plus.base_curve = Diopters(9);
  plus.center_thickness_mm = 5;
  plus.vertex_distance_mm = 12;
  for (const auto& [order, golden] :
       {std::pair{minus, 0.922034867}, std::pair{plus, 1.129596369}}) {
    const auto design = DesignLens(order);
    ASSERT_TRUE(design) << design.error().message;
    const auto lens = Certify(*design);
    ASSERT_TRUE(lens) << lens.error().message;
    const Measurement& m = Find(lens->certificate(), "magnification");
    EXPECT_NEAR(m.ordered, golden, 5e-10);
    EXPECT_NEAR(m.measured, golden, 2e-9);
  }
}

TEST(Certify, MeasuresGroundPrismWithTheBaseWhereOrdered) {
  for (const Eye eye : {Eye::kRight, Eye::kLeft}) {
    LensOrder order = test::Order160(-3, -1.5, 40);
    order.eye = eye;
    order.rx.prism_in = PrismDiopters(2.5);
    order.rx.prism_up = PrismDiopters(-1);
    const auto design = DesignLens(order);
    ASSERT_TRUE(design) << design.error().message;
    // The lens is thicker toward the base: nasally and below.
    const double nasal = eye == Eye::kRight ? -1 : 1;
    EXPECT_GT(*AxialThickness(design->lens, 15 * nasal, 0),
              *AxialThickness(design->lens, -15 * nasal, 0));
    EXPECT_GT(*AxialThickness(design->lens, 0, -15), *AxialThickness(design->lens, 0, 15));
    const auto lens = Certify(*design);
    ASSERT_TRUE(lens) << lens.error().message;
    EXPECT_NEAR(Find(lens->certificate(), "prism at the reference point, base in").measured, 2.5,
                1e-12);
    EXPECT_NEAR(Find(lens->certificate(), "prism at the reference point, base up").measured, -1,
                1e-12);
  }
}

// The pencil meets a ground back obliquely; its curvatures make up for that, to the last digit.
TEST(Certify, PrismDoesNotDisturbThePower) {
  for (const double prism : {0.5, 3.0, 10.0}) {
    LensOrder order = test::Order160(-8, -2, 65);
    order.diameter_mm = 40;
    order.rx.prism_in = PrismDiopters(prism);
    order.rx.prism_up = PrismDiopters(prism / 2);
    const auto design = DesignLens(order);
    ASSERT_TRUE(design) << design.error().message;
    const auto pencil = MeasurePower(design->lens, 1.6);
    ASSERT_TRUE(pencil);
    const PowerVector measured = PowerVectorOfLensFrame(pencil->power_D);
    const PowerVector ordered = PowerVectorOf({order.rx.sphere, order.rx.cylinder, order.rx.axis});
    EXPECT_NEAR(measured.mean, ordered.mean, kPencilPower_D);
    EXPECT_NEAR(measured.j0, ordered.j0, kPencilPower_D);
    EXPECT_NEAR(measured.j45, ordered.j45, kPencilPower_D);
    EXPECT_TRUE(Certify(*design));
  }
}

// The closed form of a lens with prism agrees with rays as closely as that of a lens without.
TEST(Certify, MagnificationIsPredictedThroughPrismToo) {
  for (const double prism : {0.0, 1e-7, 1.0, 6.0, 15.0}) {
    LensOrder order = test::Order160(5, -2, 35);
    order.diameter_mm = 40;
    order.rx.prism_in = PrismDiopters(-prism);
    order.rx.prism_up = PrismDiopters(0.4 * prism);
    const auto lens = Certify(*DesignLens(order));
    ASSERT_TRUE(lens) << lens.error().message;
    for (const Measurement& m : lens->certificate().measurements) {
      if (!m.quantity.starts_with("magnification")) continue;
      EXPECT_NEAR(m.measured, m.ordered, 2e-9) << prism;
    }
  }
}

TEST(Certify, RefusesALensThatDoesNotMatchItsOrder) {
  LensDesign design = *DesignLens(test::Order160(-6));
  design.order.rx.sphere = Diopters(-5.85);
  auto lens = Certify(design);
  ASSERT_FALSE(lens);
  EXPECT_THAT(lens.error().message, HasSubstr("back vertex power, axis meridian"));
  EXPECT_THAT(lens.error().message, HasSubstr("measured -6.0000 D, want -5.8500 +- 0.1300"));

  design = *DesignLens(test::Order160(-6));
  design.lens.back_tilt_y = 0.02;
  lens = Certify(design);
  ASSERT_FALSE(lens);
  EXPECT_THAT(lens.error().message, HasSubstr("prism"));

  design = *DesignLens(test::Order160(-6, -2, 30));
  design.order.rx.axis = AxisDegrees(32.5);
  lens = Certify(design);
  ASSERT_FALSE(lens);

  design = *DesignLens(test::Order160(6));
  design.lens.center_thickness_mm -= 4;
  EXPECT_FALSE(Certify(design));
}

// ANSI Z80.1-2015; published case 33: -3.00 may measure -2.87 to -3.13.
TEST(Tolerances, FollowTheStandard) {
  using K = LensKind;
  EXPECT_EQ(MeridianTolerance(K::kSingleVision, Diopters(-3)), 0.13);
  EXPECT_EQ(MeridianTolerance(K::kSingleVision, Diopters(-10)), 0.2);
  EXPECT_EQ(MeridianTolerance(K::kProgressive, Diopters(8)), 0.16);
  EXPECT_EQ(CylinderTolerance(K::kSingleVision, Diopters(-4.5)), 0.15);
  EXPECT_EQ(CylinderTolerance(K::kProgressive, Diopters(-3.5)), 0.18);
  EXPECT_EQ(CylinderTolerance(K::kSingleVision, Diopters(-5)), 0.2);
  EXPECT_EQ(AxisTolerance(Diopters(-0.25)), 14);
  EXPECT_EQ(AxisTolerance(Diopters(-0.75)), 5);
  EXPECT_EQ(AxisTolerance(Diopters(3)), 2);
  EXPECT_EQ(AddTolerance(Diopters(4)), 0.12);
  EXPECT_DOUBLE_EQ(PrismTolerance(Diopters(-6)), 0.6);
  EXPECT_EQ(PrismTolerance(Diopters(1)), 0.33);
}

}  // namespace
}  // namespace lorgnette
