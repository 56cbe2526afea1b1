// SPDX-License-Identifier: Apache-2.0
#include "optics/magnification.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "tests/optics/power_matrix.h"

namespace lorgnette {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

// A lens of two spheres whose exact back vertex power is `power`.
struct SphericalLens {
  Lens lens;
  ParaxialSystem system;
};
SphericalLens MakeSphericalLens(double power, double front, double thickness, double index) {
  const double tau = thickness / 1000 / index;
  const double back = power - front / (1 - tau * front);
  SphericalLens made;
  made.lens.front = Surface(SphereSurface{front / (1000 * (index - 1))});
  made.lens.back = Surface(SphereSurface{back / (1000 * (1 - index))});
  made.lens.center_thickness_mm = thickness;
  made.lens.medium.index_d = index;
  made.system = ParaxialSystem::ThickLens(Diopters(front), Diopters(back), thickness, index);
  return made;
}

constexpr double kViewDecimals = 0.5e-9 + 1e-12;

TEST(SpectacleMagnification, MatchesPublishedCases) {
  // +4 D, front +8, 4 mm, 15 mm, n 1.498: 1.022 x 1.064 = 1.087.
  EXPECT_NEAR(ShapeFactor(Diopters(8), 4, 1.498), 1.02183, 0.5e-5);
  EXPECT_NEAR(PowerFactor(Diopters(4), 15), 1.06383, 0.5e-5);
  EXPECT_NEAR(SpectacleMagnification(MakeSphericalLens(4, 8, 4, 1.498).system, 15), 1.08705,
              0.5e-5);
  // -3 D, front +4, 2 mm, 15 mm: 1.005, 0.957, 0.962.
  EXPECT_NEAR(SpectacleMagnification(MakeSphericalLens(-3, 4, 2, 1.498).system, 15), 0.96208,
              0.5e-5);
}

TEST(SpectacleMagnification, IsShapeTimesPower) {
  const auto made = MakeSphericalLens(-6, 2, 1.5, 1.6);
  EXPECT_NEAR(SpectacleMagnification(made.system, 15.05),
              ShapeFactor(Diopters(2), 1.5, 1.6) * PowerFactor(Diopters(-6), 15.05), 1e-15);
}

TEST(SpectacleMagnification, MatrixMatchesGoldenC2) {
  const auto s = AstigmaticSystem::ThickLens(test::PowerMatrix(6, 3, 30),
                                             test::PowerMatrix(-9, -4, 75), 5, 1.6);
  const Matrix2d sm = SpectacleMagnification(s, 15);
  EXPECT_NEAR(sm(0, 0), 0.93944806, 0.5e-8);  // printed to 8 decimals
  EXPECT_NEAR(sm(0, 1), -0.0089822293, kViewDecimals);
  EXPECT_NEAR(sm(1, 0), -0.0092502434, kViewDecimals);
  EXPECT_NEAR(sm(1, 1), 1.0144487, 0.5e-7);
}

TEST(ObserverParaxial, MatchesGoldenC3) {
  struct Case {
    double power, front, t, n, camera, magnification;
  };
  for (const Case& c :
       {Case{-6, 2, 1.5, 1.6, 500, 0.922034867}, Case{6, 9, 5, 1.6, 500, 1.129596369},
        Case{-12, 1, 1.2, 1.74, 600, 0.851472673}}) {
    const auto view = ObserverParaxial(MakeSphericalLens(c.power, c.front, c.t, c.n).system, c.t,
                                       {c.camera, 15.05});
    EXPECT_NEAR(view.magnification, c.magnification, kViewDecimals);
  }
  const auto minus = ObserverParaxial(MakeSphericalLens(-6, 2, 1.5, 1.6).system, 1.5, {500, 15.05});
  EXPECT_NEAR(minus.lateral, 0.9189017, 0.5e-7);
  EXPECT_NEAR(minus.apparent_depth_mm, 14.7947, 0.5e-4);
  const auto plus = ObserverParaxial(MakeSphericalLens(6, 9, 5, 1.6).system, 5, {500, 15.05});
  EXPECT_NEAR(plus.lateral, 1.131075, 0.5e-6);
  EXPECT_NEAR(plus.apparent_depth_mm, 20.7307, 0.5e-4);
}

TEST(ObserverParaxial, MagnificationFollowsFromTheImage) {
  const auto view = ObserverParaxial(MakeSphericalLens(6, 9, 5, 1.6).system, 5, {500, 15.05});
  EXPECT_NEAR(view.magnification, view.lateral * (500 + 5 + 15.05) / (500 + view.apparent_depth_mm),
              1e-14);
}

TEST(ObserverMagnification, ThinLensIsTheLimitOfTheThickOne) {
  const auto thin = ParaxialSystem::ThickLens(Diopters(2), Diopters(-8), 0, 1.6);
  EXPECT_NEAR(ObserverMagnificationThin(Diopters(-6), {500, 15.05}),
              ObserverParaxial(thin, 0, {500, 15.05}).magnification, 1e-15);
  EXPECT_NEAR(ObserverMagnificationThin(Diopters(-6), {500, 15.05}), 0.9194, 0.5e-4);
}

TEST(ObserverMagnification, FromInfinityIsTheTransposeOfTheWearers) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> power(-9, 9), angle(0, 180), t(0.5, 9), n(1.45, 1.8);
  double worst = 0;
  for (int i = 0; i < 10000; ++i) {
    const double thickness = t(random);
    const auto s = AstigmaticSystem::ThickLens(
        test::PowerMatrix(power(random), power(random) / 3, angle(random)),
        test::PowerMatrix(power(random), power(random) / 3, angle(random)), thickness, n(random));
    // At 1e9 mm the finite-distance terms are below 1e-7 of the whole.
    const Matrix2d seen = ObserverMagnification(s, thickness, {1e12, 15});
    worst = std::max(worst, (seen - SpectacleMagnification(s, 15).transpose()).norm());
  }
  // Terms of order (t + z) / L = 2e-11.
  EXPECT_LT(worst, 1e-10);
}

TEST(SpectacleMagnificationNear, IsWhatACameraAtTheObjectSeesOfThePupil) {
  const auto made = MakeSphericalLens(5, 8, 4, 1.6);
  for (const double distance : {250.0, 400.0, 2000.0}) {
    EXPECT_NEAR(SpectacleMagnificationNear(made.system, 4, 15, distance),
                ObserverParaxial(made.system, 4, {distance, 15}).magnification, 1e-14);
  }
  EXPECT_NEAR(SpectacleMagnificationNear(made.system, 4, 15, 1e12),
              SpectacleMagnification(made.system, 15), 1e-10);
}

TEST(ObserverExact, MatchesTheLadderOfGoldenC8) {
  const auto made = MakeSphericalLens(-6, 2, 1.5, 1.6);
  struct Row {
    double height, magnification;
  };
  for (const Row& row : {Row{6, 0.92273}, Row{15, 0.92657}, Row{20, 0.93046}, Row{25, 0.93606}}) {
    const auto ray = ObserverExact(made.lens, 1.6, {500, 15.05}, Vector2d(0, row.height));
    ASSERT_TRUE(ray);
    EXPECT_NEAR(ray->magnification, row.magnification, 0.5e-5);  // printed to 5 decimals
  }
}

TEST(ObserverExact, ApproachesTheClosedFormOnTheAxis) {
  struct Case {
    double power, front, t, n;
  };
  // Coma-free on the axis: the ratio departs by O(h^2), 1e-6 mm^2 of curvatures below 0.1 / mm,
  // beside rounding of 500 mm * 1e-16 over a height of 1e-3 mm.
  constexpr double kNearAxis = 1e-9;
  for (const Case& c : {Case{-6, 2, 1.5, 1.6}, Case{6, 9, 5, 1.6}, Case{-12, 1, 1.2, 1.74},
                        Case{0, 6, 2, 1.5}, Case{20, 22, 9, 1.74}}) {
    const auto made = MakeSphericalLens(c.power, c.front, c.t, c.n);
    const ObserverGeometry geometry{500, 15.05};
    const auto ray = ObserverExact(made.lens, c.n, geometry, Vector2d(0, 0));
    ASSERT_TRUE(ray);
    EXPECT_NEAR(ray->magnification, ObserverParaxial(made.system, c.t, geometry).magnification,
                kNearAxis);
  }
}

TEST(ObserverExact, FollowsTheMatrixFormOfAToricLensNearTheAxis) {
  TorusSurface torus;
  torus.curvature_generator = 1 / 54.47089646;
  torus.curvature_across = 1 / 74.85911083;
  torus.generator_angle = RadiansFromDegrees(120);
  Lens lens;
  lens.front = Surface(SphereSurface{4.0 / 600});
  lens.back = Surface(torus);
  lens.center_thickness_mm = 1.5;
  const ObserverGeometry geometry{500, 15.05};
  const Matrix2d m = ObserverMagnification(lens, 1.6, geometry);
  for (const double angle : {0.0, 0.7, 1.9, 3.0}) {
    const Vector2d feature = 1e-2 * Vector2d(std::cos(angle), std::sin(angle));
    const auto ray = ObserverExact(lens, 1.6, geometry, feature);
    ASSERT_TRUE(ray);
    const Vector2d expected = m * feature / (500 + 1.5 + 15.05);
    // Third-order aberration over first: (h c)^2 ~ (1e-2 / 50)^2.
    EXPECT_LT((ray->camera_tangent - expected).norm(), 1e-7 * expected.norm());
  }
}

TEST(ObserverExact, ReturnsNulloptWhenTheFeatureCannotBeSeen) {
  // -20 D, front +0.5: the back surface ends 24.4 mm from the axis.
  const auto made = MakeSphericalLens(-20, 0.5, 1.5, 1.5);
  EXPECT_FALSE(ObserverExact(made.lens, 1.5, {500, 15.05}, Vector2d(0, 80)));
  EXPECT_TRUE(ObserverExact(made.lens, 1.5, {500, 15.05}, Vector2d(0, 5)));
}

}  // namespace
}  // namespace lorgnette
