// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "tests/optics/power_matrix.h"

namespace lorgnette {
namespace {

using Eigen::Matrix2d;

// Long's matrix for a cylinder axis given as a mathematical angle in a right-handed frame.
// Published values are printed to this many decimals.
constexpr double kTwoDecimals = 0.005 + 1e-9;
constexpr double kNineDecimals = 0.5e-9 + 1e-12;

TEST(ParaxialSystem, BackVertexPowerMatchesPublishedCases) {
  struct Case {
    double f1, f2, t_mm, n, published;
  };
  for (const Case& c : {Case{10.25, -3, 4, 1.586, 7.52}, Case{15, -6, 6.5, 1.523, 10.03},
                        Case{16, -2, 11.4, 1.532, 16.16}}) {
    const auto s = ParaxialSystem::ThickLens(Diopters(c.f1), Diopters(c.f2), c.t_mm, c.n);
    EXPECT_NEAR(s.BackVertexPower().value(), c.published, kTwoDecimals);
  }
  const auto third = ParaxialSystem::ThickLens(Diopters(16), Diopters(-2), 11.4, 1.532);
  EXPECT_NEAR(third.EquivalentPower().value(), 14.24, kTwoDecimals);
  EXPECT_NEAR(third.Cardinal()->back_focal_mm, 61.87, kTwoDecimals);
}

TEST(ParaxialSystem, CardinalPointsMatchGoldenC1) {
  const Diopters f1(2), f2(-8.00375704445836);
  const auto s = ParaxialSystem::ThickLens(f1, f2, 1.5, 1.6);
  const auto points = s.Cardinal();
  ASSERT_TRUE(points);
  const double efl = 1000 / s.EquivalentPower().value();
  EXPECT_NEAR(efl, -166.979753704863, 1e-9);                 // printed to 12 decimals
  EXPECT_NEAR(points->back_focal_mm, -166.6666667, 0.5e-7);  // printed to 7 decimals
  EXPECT_NEAR(s.FrontVertexPower().value(), -5.944147953696, 1e-12);
  EXPECT_NEAR(points->back_focal_mm - points->back_principal_mm, efl, 1e-10);
  EXPECT_NEAR(points->front_principal_mm - points->front_focal_mm, efl, 1e-10);
  // Principal points from powers: tau F2 / Fe and -tau F1 / Fe.
  const double tau_mm = 1.5 / 1.6, fe = s.EquivalentPower().value();
  EXPECT_NEAR(points->front_principal_mm, tau_mm * f2.value() / fe, 1e-12);
  EXPECT_NEAR(points->back_principal_mm, -tau_mm * f1.value() / fe, 1e-12);
}

TEST(ParaxialSystem, AfocalSystemHasNoCardinalPointsAndFinitePowers) {
  // F2 = -F1 / (1 - tau F1): a Galilean telescope in one piece of glass.
  const double tau = 0.006 / 1.5;
  const auto s = ParaxialSystem::ThickLens(Diopters(10), Diopters(-10 / (1 - tau * 10)), 6, 1.5);
  EXPECT_FALSE(s.Cardinal());
  EXPECT_NEAR(s.BackVertexPower().value(), 0, 1e-13);  // rounding of two powers near 10 D
  EXPECT_NEAR(1 / s.a, 1 / (1 - tau * 10), 1e-15);     // its angular magnification
}

TEST(ParaxialSystem, ConcentricLensHasItsPrincipalPointsAtTheCommonCentre) {
  const double n = 1.5, r1 = 100, t = 5, r2 = r1 - t;
  const auto s =
      ParaxialSystem::ThickLens(Diopters(1000 * (n - 1) / r1), Diopters(1000 * (1 - n) / r2), t, n);
  EXPECT_NEAR(s.Cardinal()->front_principal_mm, r1, 1e-9);  // 1e-12 relative over Fe ~ 0.09 D
  EXPECT_NEAR(s.Cardinal()->back_principal_mm, r2, 1e-9);
}

TEST(AstigmaticSystem, MatchesGoldenC2) {
  const Matrix2d f1 = test::PowerMatrix(6, 3, 30), f2 = test::PowerMatrix(-9, -4, 75);
  const auto s = AstigmaticSystem::ThickLens(f1, f2, 5, 1.6);
  const Matrix2d fv = s.BackVertexPower();
  EXPECT_NEAR(fv(0, 0), -5.830951006, kNineDecimals);
  EXPECT_NEAR(fv(0, 1), -0.3621715651, kNineDecimals);
  EXPECT_NEAR(fv(1, 1), -0.7939491515, kNineDecimals);
  const Matrix2d fe = s.EquivalentPower();
  EXPECT_NEAR(std::abs(fe(0, 1) - fe(1, 0)), 0.01875, 0.5e-5);  // printed to 5 decimals
}

TEST(AstigmaticSystem, VertexPowersMatchTheirClosedForms) {
  const Matrix2d f1 = test::PowerMatrix(6, 3, 30), f2 = test::PowerMatrix(-9, -4, 75);
  const double tau = 0.005 / 1.6;
  const auto s = AstigmaticSystem::ThickLens(f1, f2, 5, 1.6);
  const Matrix2d back = f2 + f1 * (Matrix2d::Identity() - tau * f1).inverse();
  const Matrix2d front = f1 + f2 * (Matrix2d::Identity() - tau * f2).inverse();
  constexpr double kRounding = 1e-13;  // a few ulps of 13 D
  EXPECT_LT((s.BackVertexPower() - back).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_LT((s.FrontVertexPower() - front).cwiseAbs().maxCoeff(), kRounding);
}

TEST(AstigmaticSystem, RandomLensesAreSymplecticAndReverseToSwappedVertexPowers) {
  std::mt19937_64 random(20261122);
  std::uniform_real_distribution<double> log_power(-3, 1.5), angle(0, 180), index(1.45, 1.9),
      thickness(0.1, 12);
  std::bernoulli_distribution negative(0.5);
  const auto power = [&] {
    return (negative(random) ? -1 : 1) * std::pow(10.0, log_power(random));
  };
  double worst_symplectic = 0, worst_reversal = 0;
  for (int i = 0; i < 10000; ++i) {
    const Matrix2d f1 = test::PowerMatrix(power(), power(), angle(random));
    const Matrix2d f2 = test::PowerMatrix(power(), power(), angle(random));
    const double t = thickness(random), n = index(random);
    const auto s = AstigmaticSystem::ThickLens(f1, f2, t, n);
    const auto reversed = AstigmaticSystem::ThickLens(f2, f1, t, n);
    worst_symplectic = std::max(worst_symplectic, s.SymplecticDefect() / (1 + s.c_D.norm()));
    worst_reversal =
        std::max(worst_reversal, (s.BackVertexPower() - reversed.FrontVertexPower()).norm() /
                                     ((1 + s.c_D.norm()) / std::abs(s.a.determinant())));
  }
  std::printf("worst symplectic defect %.2g, reversal %.2g (relative)\n", worst_symplectic,
              worst_reversal);
  constexpr double kRelativeRounding = 64 * std::numeric_limits<double>::epsilon();
  EXPECT_LT(worst_symplectic, kRelativeRounding);
  EXPECT_LT(worst_reversal, kRelativeRounding);
}

TEST(AstigmaticSystem, SphericalPowersReduceToTheSymmetricSystem) {
  const auto s = ParaxialSystem::ThickLens(Diopters(4), Diopters(-9), 2, 1.6);
  const auto m =
      AstigmaticSystem::ThickLens(4 * Matrix2d::Identity(), -9 * Matrix2d::Identity(), 2, 1.6);
  EXPECT_NEAR(s.determinant(), 1, 1e-15);
  EXPECT_NEAR(m.BackVertexPower()(0, 0), s.BackVertexPower().value(), 1e-14);
  EXPECT_EQ(m.BackVertexPower()(0, 1), 0);
  EXPECT_NEAR(m.Matrix().determinant(), 1, 1e-14);
}

TEST(AstigmaticSystem, SingularVertexPowerIsInfiniteNeverNan) {
  // tau F1 = 1 exactly: tau = 2^-6 m, F1 = 64 D.
  const auto s = AstigmaticSystem::ThickLens(64 * Matrix2d::Identity(), Matrix2d::Identity(),
                                             15.625 * 1.5, 1.5);
  EXPECT_TRUE(s.BackVertexPower().array().isInf().all());
  EXPECT_TRUE(s.FrontVertexPower().allFinite());
}

TEST(SurfacePower, OfATorusHasThePrincipalPowersInItsMeridians) {
  TorusSurface torus;
  torus.curvature_generator = 1.0 / 54.5;
  torus.curvature_across = 1.0 / 75;
  torus.generator_angle = RadiansFromDegrees(120);
  const Matrix2d power = SurfacePower(Surface(torus), 1.6, 1);
  const Eigen::Vector2d along(std::cos(torus.generator_angle), std::sin(torus.generator_angle));
  const Eigen::Vector2d across(-along.y(), along.x());
  constexpr double kRounding = 1e-13;
  EXPECT_NEAR(along.dot(power * along), -600 / 54.5, kRounding);
  EXPECT_NEAR(across.dot(power * across), -600 / 75.0, kRounding);
  EXPECT_NEAR(along.dot(power * across), 0, kRounding);
}

TEST(PaperPower, DiffersFromTheExactOneByItsStatedRemainder) {
  struct Case {
    double n, t_mm, f1, remainder, half_digit;
  };
  for (const Case& c : {Case{1.6, 1.5, 2, 7.0e-6, 0.05e-6}, Case{1.5, 5, 8, 0.00584, 0.5e-5},
                        Case{1.74, 7, 12, 0.0294, 0.5e-4}, Case{1.5, 8, 14, 0.0843, 0.5e-4},
                        Case{1.5, 9, 16, 0.163, 0.5e-3}}) {
    const Diopters f1(c.f1), f2(-6);
    const double exact = ParaxialSystem::ThickLens(f1, f2, c.t_mm, c.n).BackVertexPower().value();
    const double paper = PaperPower(f1, f2, c.t_mm, c.n).value();
    const double stated = PaperPowerError(f1, c.t_mm, c.n).value();
    EXPECT_NEAR(exact - paper, stated, 1e-13);  // rounding of powers near 20 D
    EXPECT_NEAR(stated, c.remainder, c.half_digit);
  }
}

TEST(MovedTowardEye, MatchesPublishedVertexCompensations) {
  struct Case {
    double power, toward_eye_mm, published, half_digit;
  };
  for (const Case& c :
       {Case{-12, -4, -12.61, 0.0051}, Case{-4, 12, -3.82, 0.005}, Case{-8, 12, -7.30, 0.005},
        Case{-10, 12, -8.93, 0.005}, Case{-15, 12, -12.71, 0.005}, Case{4, 12, 4.20, 0.005},
        Case{6, 12, 6.47, 0.005}, Case{8, 12, 8.85, 0.005}, Case{10, 12, 11.36, 0.005},
        Case{-6, 12, -5.59, 0.01}, Case{5, 10, 5.26, 0.005}, Case{10, 20, 12.50, 0.005}}) {
    EXPECT_NEAR(MovedTowardEye(Diopters(c.power), c.toward_eye_mm).value(), c.published,
                c.half_digit);
  }
}

TEST(MovedTowardEye, MatrixFormActsOnEachPrincipalMeridian) {
  const Matrix2d moved = MovedTowardEye(test::PowerMatrix(-5, -3, 25), 12);
  const Matrix2d expected = test::PowerMatrix(-5 / 1.06, -8 / (1 + 0.012 * 8) + 5 / 1.06, 25);
  EXPECT_LT((moved - expected).cwiseAbs().maxCoeff(), 1e-14);
  const Matrix2d back = MovedTowardEye(moved, -12);
  EXPECT_LT((back - test::PowerMatrix(-5, -3, 25)).cwiseAbs().maxCoeff(), 1e-14);
}

}  // namespace
}  // namespace lorgnette
