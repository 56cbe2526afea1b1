// SPDX-License-Identifier: Apache-2.0
#include "optics/gaze.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "base/units.h"
#include "optics/paraxial.h"

namespace lorgnette {
namespace {

Lens GoldenC1() {
  Lens lens;
  lens.front = Surface(SphereSurface{1 / 300.0});
  lens.back = Surface(SphereSurface{8.00375704445836 / 600});
  lens.center_thickness_mm = 1.5;
  return lens;
}

// Rx -4 -3 axis 30 (mathematical angle in the lens frame), front +4, n 1.6, t 1.5, exact torus.
Lens GoldenC4(double generator_deg) {
  const double tau = 0.0015 / 1.6;
  const double back_along = -4 - 4 / (1 - tau * 4), back_across = back_along - 3;
  const double c_along = -back_along / 600, c_across = -back_across / 600;
  Lens lens;
  lens.front = Surface(SphereSurface{4.0 / 600});
  TorusSurface torus;
  torus.generator_angle = RadiansFromDegrees(generator_deg);
  torus.curvature_generator = generator_deg == 30 ? c_along : c_across;
  torus.curvature_across = generator_deg == 30 ? c_across : c_along;
  lens.back = Surface(torus);
  lens.center_thickness_mm = 1.5;
  return lens;
}

constexpr double kGazeDecimals = 0.5e-9 + 1e-11;
constexpr double kSixDecimals = 0.5e-6 + 1e-11;
constexpr double kAxisDecimals_deg = 0.5e-5 + 1e-9;  // printed to five decimals

TEST(EvaluateGaze, MatchesGoldenC1AtThirtyDegreesOfEyeRotation) {
  const Lens lens = GoldenC1();
  const auto gaze = EvaluateGaze(lens, 1.6, EyePose::OnAxis(lens, 27), {RadiansFromDegrees(30), 0});
  ASSERT_EQ(gaze.status, RayStatus::kOk);
  EXPECT_NEAR(gaze.sagittal_D, -5.957632772, kGazeDecimals);
  EXPECT_NEAR(gaze.tangential_D, -6.419885812, kGazeDecimals);
  const double object_angle = std::acos(gaze.object_ray.direction.z());
  EXPECT_NEAR(DegreesFromRadians(object_angle), 35.937154, kSixDecimals);
  const GazeErrors errors = ErrorsOf(gaze, SystemOf(lens, 1.6).BackVertexPower());
  EXPECT_NEAR(errors.oblique_astigmatism_D, -0.462253, kSixDecimals);
  EXPECT_NEAR(errors.mean_oblique_D, -0.188759, kSixDecimals);
}

TEST(EvaluateGaze, MatchesGoldenC1AtThirtyDegreesOfObjectField) {
  const Lens lens = GoldenC1();
  const auto gaze =
      EvaluateGaze(lens, 1.6, EyePose::OnAxis(lens, 27), {RadiansFromDegrees(25.301040), 0});
  EXPECT_NEAR(DegreesFromRadians(std::acos(gaze.object_ray.direction.z())), 30, 1e-6);
  // The eye's angle is given to 5e-7 deg; the errors change by 0.03 D a degree.
  EXPECT_NEAR(gaze.sagittal_D, -5.978570794, 2e-8);
  EXPECT_NEAR(gaze.tangential_D, -6.321082942, 2e-8);
}

TEST(EvaluateGaze, IsTheSameInEveryMeridianOfASphericalLens) {
  const Lens lens = GoldenC1();
  for (const double phi : {0.3, 1.9, 4.4}) {
    const auto gaze =
        EvaluateGaze(lens, 1.6, EyePose::OnAxis(lens, 27), {RadiansFromDegrees(30), phi});
    EXPECT_NEAR(gaze.sagittal_D, -5.957632772, kGazeDecimals);
    EXPECT_NEAR(gaze.tangential_D, -6.419885812, kGazeDecimals);
    // No cross term in the plane of gaze: Listing's axes keep the meridian.
    EXPECT_NEAR(gaze.power.cylinder.value(), -0.46225304, 1e-8);
  }
}

TEST(EvaluateGaze, MatchesGoldenC4) {
  struct Row {
    double generator_deg, theta, phi, sphere, cylinder, axis;
  };
  for (const Row& row : {Row{120, 20, 45, -4.062194, -2.916665, 29.60786},
                         Row{120, 30, 0, -4.002467, -2.904593, 31.09722},
                         Row{120, 30, 90, -3.773999, -3.071410, 29.04821},
                         Row{120, 30, 135, -3.694691, -3.125294, 30.52178},
                         Row{30, 20, 45, -4.064269, -2.946910, 29.26745}}) {
    const Lens lens = GoldenC4(row.generator_deg);
    const auto gaze = EvaluateGaze(lens, 1.6, EyePose::OnAxis(lens, 27),
                                   {RadiansFromDegrees(row.theta), RadiansFromDegrees(row.phi)});
    ASSERT_EQ(gaze.status, RayStatus::kOk);
    EXPECT_NEAR(gaze.power.sphere.value(), row.sphere, kSixDecimals);
    EXPECT_NEAR(gaze.power.cylinder.value(), row.cylinder, kSixDecimals);
    // The golden's angle is mathematical in a right-handed frame; TABO mirrors it.
    EXPECT_NEAR(180 - gaze.power.axis.value(), row.axis, kAxisDecimals_deg);
  }
}

TEST(EvaluateGaze, IsTheBackVertexPowerInPrimaryGaze) {
  const Lens lens = GoldenC4(120);
  const auto gaze = EvaluateGaze(lens, 1.6, EyePose::OnAxis(lens, 27), {0, 0});
  const Eigen::Matrix2d power = SystemOf(lens, 1.6).BackVertexPower();
  EXPECT_LT((gaze.vergence_D - power).norm(), 1e-12);
  EXPECT_LT(std::abs(ErrorsOf(gaze, power).error.mean), 1e-12);
}

TEST(EvaluateGaze, TakesTheVergenceOfANearObject) {
  // On the axis: (V) leaves as F'v of the object's vergence -2.5 D at the front vertex.
  const Lens lens = GoldenC1();
  const auto gaze = EvaluateGaze(lens, 1.6, EyePose::OnAxis(lens, 27), {0, 0}, 400);
  const double tau = 0.0015 / 1.6, in = -2.5 + 2;
  EXPECT_NEAR(gaze.sagittal_D, in / (1 - tau * in) - 8.00375704445836, 1e-12);
}

TEST(EvaluateGaze, OrderOfTheSchemeIsThatOfTheThirdOrderFormula) {
  // Thin lens limit of the third-order theory: OAE = F theta^2 a, MOE = F theta^2 (2a + b) / 2.
  const double n = 1.5, f = -6, f1 = 4, s = 27;
  Lens lens;
  lens.front = Surface(SphereSurface{f1 / (1000 * (n - 1))});
  lens.back = Surface(SphereSurface{(f1 - f) / (1000 * (n - 1))});
  lens.center_thickness_mm = 0;
  const double theta = 0.01, z = 1000 / s;
  const double q = (n + 2) * f1 * f1 - ((n + 2) * f + 2 * (n * n - 1) * z) * f1 +
                   n * (f + (n - 1) * z) * (f + (n - 1) * z);
  const double a = q / (z * z * n * (n - 1) * (n - 1));
  const double b = (1 - f / z) * ((1 - f / z) / n - 1);
  const auto gaze = EvaluateGaze(lens, n, EyePose::OnAxis(lens, s), {theta, 0.4});
  const double scale = f * theta * theta;
  // The next order is theta^2 times a factor of a few.
  EXPECT_NEAR(gaze.tangential_D - gaze.sagittal_D, scale * a, std::abs(scale) * 10 * theta * theta);
  EXPECT_NEAR(gaze.sagittal_D - f, scale * (a + b) / 2, std::abs(scale) * 10 * theta * theta);
}

TEST(EvaluateGaze, ReportsRaysThatTheLensLoses) {
  Lens lens = GoldenC1();
  lens.back = Surface(SphereSurface{1 / 12.0});
  const auto gaze = EvaluateGaze(lens, 1.6, EyePose::OnAxis(lens, 27), {RadiansFromDegrees(40), 0});
  EXPECT_NE(gaze.status, RayStatus::kOk);
}

TEST(ListingRotation, HasNoTorsionAboutTheGaze) {
  const Eigen::Vector3d g = Gaze{0.5, 0.8}.Direction();
  const Eigen::Matrix3d r = ListingRotation(g);
  EXPECT_LT((r * -Eigen::Vector3d::UnitZ() - g).norm(), 1e-15);
  // The axis across both is fixed.
  const Eigen::Vector3d axis(-std::sin(0.8), std::cos(0.8), 0);
  EXPECT_LT((r * axis - axis).norm(), 1e-15);
}

}  // namespace
}  // namespace lorgnette
