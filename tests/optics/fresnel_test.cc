// SPDX-License-Identifier: Apache-2.0
#include "optics/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optics/trace.h"

namespace lorgnette {
namespace {

constexpr double kEnergyRounding = 1e-14;

TEST(Fresnel, ConservesEnergyAtEveryAngleAndPolarization) {
  for (const double n2 : {1.0, 1.33, 1.5, 1.74}) {
    for (int deg = 0; deg < 90; ++deg) {
      const double c = std::cos(RadiansFromDegrees(deg));
      for (const auto& power : {FresnelPower(c, 1, n2), FresnelPower(c, n2, 1)}) {
        EXPECT_NEAR(power.rs + power.ts, 1, kEnergyRounding);
        EXPECT_NEAR(power.rp + power.tp, 1, kEnergyRounding);
      }
    }
  }
}

TEST(Fresnel, AveragesToTheUnpolarizedReflectance) {
  for (const double eta : {1 / 1.6, 1.6}) {
    for (const double c : {1.0, 0.9, 0.5, 0.1, 0.01}) {
      EXPECT_NEAR(FresnelPower(c, eta, 1).reflectance(), FresnelReflectance(c, eta),
                  kEnergyRounding);
    }
  }
}

TEST(Fresnel, ReflectsNoPLightAtBrewstersAngle) {
  const double angle = BrewsterAngle(1, 1.523);
  const PolarizedPower power = FresnelPower(std::cos(angle), 1, 1.523);
  EXPECT_LT(power.rp, 1e-30);
  EXPECT_NEAR(power.reflected_polarization(), 1, kEnergyRounding);
}

TEST(Fresnel, ReflectsAllPastTheCriticalAngleWithAPhase) {
  const double angle = *CriticalAngle(1.5, 1);
  EXPECT_NEAR(DegreesFromRadians(angle), 41.8, 0.05);
  EXPECT_NEAR(DegreesFromRadians(*CriticalAngle(1.74, 1)), 35.1, 0.05);
  EXPECT_FALSE(CriticalAngle(1, 1.5));
  const FresnelAmplitudes a = Fresnel(std::cos(angle + 0.2), 1.5, 1);
  EXPECT_NEAR(std::abs(a.rs), 1, kEnergyRounding);
  EXPECT_NEAR(std::abs(a.rp), 1, kEnergyRounding);
  EXPECT_GT(std::abs(a.rs.imag()), 0.1);
  EXPECT_EQ(FresnelPower(std::cos(angle + 0.2), 1.5, 1).ts, 0);
}

TEST(Fresnel, IsReciprocalAcrossTheInterface) {
  // Stokes: r' = -r and t t' = 1 - r^2 at conjugate angles.
  const double sin1 = 0.6, n = 1.6, c1 = 0.8, c2 = std::sqrt(1 - sin1 * sin1 / (n * n));
  const FresnelAmplitudes in = Fresnel(c1, 1, n), out = Fresnel(c2, n, 1);
  EXPECT_NEAR((in.rs + out.rs).real(), 0, kEnergyRounding);
  EXPECT_NEAR((in.rp + out.rp).real(), 0, kEnergyRounding);
  EXPECT_NEAR((in.ts * out.ts + in.rs * in.rs).real(), 1, kEnergyRounding);
}

TEST(PlateTransmittance, MatchesThePublishedTable) {
  struct Row {
    double n, r, single, all;
  };
  for (const Row& row : {Row{1.498, 3.974, 92.209, 92.355}, Row{1.5, 4.000, 92.160, 92.308},
                         Row{1.523, 4.297, 91.591, 91.760}, Row{1.586, 5.135, 89.994, 90.232},
                         Row{1.6, 5.325, 89.633, 89.888}, Row{1.67, 6.297, 87.803, 88.152},
                         Row{1.74, 7.294, 85.944, 86.404}}) {
    constexpr double kThreeDecimals = 0.0005 + 1e-9;
    EXPECT_NEAR(100 * FresnelPower(1, 1, row.n).reflectance(), row.r, kThreeDecimals);
    const PlatePower plate = PlateTransmittance(1, row.n);
    EXPECT_NEAR(100 * plate.single_pass, row.single, kThreeDecimals);
    EXPECT_NEAR(100 * plate.transmitted, row.all, kThreeDecimals);
    EXPECT_NEAR(plate.transmitted, 2 * row.n / (row.n * row.n + 1), kEnergyRounding);
    EXPECT_NEAR(plate.transmitted + plate.reflected, 1, kEnergyRounding);
  }
}

TEST(PlateTransmittance, EqualsTheSumOfItsBouncesOneByOne) {
  const double n = 1.6, glass = 0.7, r = FresnelPower(1, 1, n).reflectance();
  double inside = (1 - r) * glass, sum = 0;
  for (int i = 0; i < 40; ++i) {
    sum += inside * (1 - r);
    inside *= r * r * glass * glass;
  }
  EXPECT_NEAR(PlateTransmittance(1, n, glass).transmitted, sum, kEnergyRounding);
}

TEST(Ghost, OfAThinLensHasSevenTimesThePowerAtIndexOneAndAHalf) {
  Lens lens;
  lens.front = Surface(SphereSurface{0.010});
  lens.back = Surface(SphereSurface{0.002});
  const Ghost ghost = GhostOf(lens, 1.5);
  const double power = 1000 * 0.5 * 0.008;
  EXPECT_NEAR(ghost.power.value(), 7 * power, 1e-12);
  EXPECT_NEAR(ghost.relative_intensity, 0.04 * 0.04, kEnergyRounding);
  // For other indices F (3 n - 1) / (n - 1).
  EXPECT_NEAR(GhostOf(lens, 1.7).power.value(), 1000 * 0.008 * (3 * 1.7 - 1), 1e-12);
}

TEST(Ghost, AgreesWithATracedParaxialRay) {
  Lens lens;
  lens.front = Surface(SphereSurface{1 / 70.0});
  lens.back = Surface(SphereSurface{1 / 200.0});
  lens.center_thickness_mm = 4;
  const double n = 1.6, h = 1e-4;
  const Ray start{{0, h, -5}, {0, 0, 1}};
  const auto front = lens.front.Intersect(start);
  Ray ray{front->point, *Refract(start.direction, front->normal, 1 / n)};
  const auto back = IntersectBack(lens, ray);
  ray = {back->point, Reflect(ray.direction, back->normal)};
  const auto again = lens.front.Intersect(ray);
  ray = {again->point, Reflect(ray.direction, again->normal)};
  const auto out = IntersectBack(lens, ray);
  const Eigen::Vector3d exit = *Refract(ray.direction, out->normal, n);
  const double vergence = -1000 * exit.y() / exit.z() / out->point.y();
  // Spherical aberration: (h c)^2 of 1e-12, and rounding 1e-16 over h.
  EXPECT_NEAR(vergence, GhostOf(lens, n).power.value(), 1e-8);
}

}  // namespace
}  // namespace lorgnette
