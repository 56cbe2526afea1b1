// SPDX-License-Identifier: Apache-2.0
#include "optics/coddington.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <random>

#include "base/units.h"
#include "tests/optics/lens_oracle.h"

namespace lorgnette {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct RandomLens {
  Lens lens;
  double index;
};

// Sphere or torus on either side, curvatures log-uniform to 1/40 mm, with a ground prism.
RandomLens MakeRandomLens(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1), turn(0, kPi);
  const auto curvature = [&] {
    return (unit(random) < 0.5 ? -1 : 1) * std::pow(10.0, -6 + 4.4 * unit(random));
  };
  const auto surface = [&]() -> Surface {
    if (unit(random) < 0.5) return Surface(SphereSurface{curvature()});
    return Surface(TorusSurface{curvature(), curvature(), turn(random)});
  };
  RandomLens made;
  made.lens.front = surface();
  made.lens.back = surface();
  made.lens.center_thickness_mm = 1 + 8 * unit(random);
  if (unit(random) < 0.3) {
    made.lens.back_tilt_x = 0.1 * (unit(random) - 0.5);
    made.lens.back_tilt_y = 0.1 * (unit(random) - 0.5);
  }
  made.index = 1.45 + 0.45 * unit(random);
  return made;
}

Ray MakeRandomRay(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const Vector3d aim(14 * unit(random), 14 * unit(random), 0);
  const double z = unit(random) < 0 ? -1 : 1;
  const Vector3d d = Vector3d(0.6 * unit(random), 0.6 * unit(random), z).normalized();
  return {aim - 30 * d, d};
}

TEST(Coddington, AgreesWithDifferentialRaysOverRandomLenses) {
  std::mt19937_64 random(5);
  double worst = 0;
  int compared = 0;
  for (int i = 0; i < 10000; ++i) {
    const RandomLens made = MakeRandomLens(random);
    const Ray ray = MakeRandomRay(random);
    const auto wave = TraceWavefront(made.lens, made.index, SphericalWave(ray, 0));
    const auto rays = TraceDifferential(made.lens, made.index, ray, ParallelDifferential(ray));
    ASSERT_EQ(wave.status, rays.status);
    if (wave.status != RayStatus::kOk) continue;
    const Matrix3d other = VergenceOf(rays.exit, rays.differential);
    // Both are only as good as the ray near grazing exit, where vergence grows without bound.
    if (wave.exit.vergence_D.norm() > 100) continue;
    ++compared;
    worst = std::max(worst, (wave.exit.vergence_D - other).cwiseAbs().maxCoeff());
  }
  std::printf("Coddington against differential rays: %d rays, worst %.2g D\n", compared, worst);
  EXPECT_GT(compared, 8000);
  EXPECT_LT(worst, kCoddingtonAgreement_D);
}

TEST(Coddington, AgreesWithFiniteDifferencesOfLongDoubleRays) {
  std::mt19937_64 random(6);
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    const RandomLens made = MakeRandomLens(random);
    const Ray ray = MakeRandomRay(random);
    const auto wave = TraceWavefront(made.lens, made.index, SphericalWave(ray, 0));
    if (wave.status != RayStatus::kOk || wave.exit.vergence_D.norm() > 100) continue;
    const auto e = AcrossBasis(ray.direction);
    RayDifferential difference;
    // Central differences: truncation h^2 c^2 of 1e-8 relative, rounding 1e-19 / 1e-3.
    constexpr double kStep_mm = 1e-3;
    bool ok = true;
    for (int k = 0; k < 2 && ok; ++k) {
      const auto at = [&](double h) {
        return oracle::TraceLens(made.lens, (ray.origin + h * e.col(k)).cast<oracle::Real>(),
                                 ray.direction.cast<oracle::Real>().normalized(), made.index);
      };
      const auto plus = at(kStep_mm), minus = at(-kStep_mm);
      ok = plus.status == RayStatus::kOk && minus.status == RayStatus::kOk;
      if (!ok) break;
      difference.origin.col(k) =
          ((plus.second.point - minus.second.point) / (2 * kStep_mm)).cast<double>();
      difference.direction.col(k) = ((plus.exit - minus.exit) / (2 * kStep_mm)).cast<double>();
    }
    if (!ok) continue;
    ++compared;
    const Matrix3d other = VergenceOf(wave.exit.chief, difference);
    EXPECT_LT((wave.exit.vergence_D - other).norm(), 1e-6 * (1 + wave.exit.vergence_D.norm()));
  }
  EXPECT_GT(compared, 150);
}

TEST(Coddington, IsTheVertexPowerOnTheAxis) {
  Lens lens;
  lens.front = Surface(SphereSurface{1 / 300.0});
  lens.back = Surface(SphereSurface{8.00375704445836 / 600});
  lens.center_thickness_mm = 1.5;
  const auto wave = TraceWavefront(lens, 1.6, SphericalWave({{0, 0, -10}, {0, 0, 1}}, 0));
  ASSERT_EQ(wave.status, RayStatus::kOk);
  EXPECT_NEAR(wave.exit.vergence_D(0, 0), -6, 1e-12);  // the power is given to 14 decimals
  EXPECT_NEAR(wave.exit.vergence_D(1, 1), -6, 1e-12);
  EXPECT_EQ(wave.exit.vergence_D(0, 1), 0);
  EXPECT_EQ(wave.exit.vergence_D(2, 2), 0);
}

TEST(Coddington, IsContinuousThroughNormalIncidence) {
  Lens lens;
  lens.front = Surface(TorusSurface{0.012, 0.008, 0.4});
  lens.back = Surface(SphereSurface{0.02});
  lens.center_thickness_mm = 2;
  const Matrix3d straight =
      TraceWavefront(lens, 1.5, SphericalWave({{0, 0, -10}, {0, 0, 1}}, 0)).exit.vergence_D;
  for (const double slope : {1e-15, 1e-12, 1e-9, 1e-7}) {
    const Vector3d d = Vector3d(slope, -slope, 1).normalized();
    const auto wave = TraceWavefront(lens, 1.5, SphericalWave({-10 * d, d}, 0));
    // First order in the slope at most: turning of the ray and the moved second hit.
    EXPECT_LT((wave.exit.vergence_D - straight).norm(), 1e-12 + 50 * slope);
  }
}

TEST(Coddington, MarginalSphereSurfaceMatchesTheScalarEquations) {
  // One refracting sphere, ray in its meridian: sagittal and tangential forms of the textbook.
  const double r = 50, n = 1.6, angle = 0.5;
  const Vector3d normal(-std::sin(angle), 0, std::cos(angle));
  SurfaceBend bend{normal, (Matrix3d::Identity() - normal * normal.transpose()) / r};
  const Vector3d in(0, 0, 1);
  const Vector3d out = *Refract(in, normal, 1 / n);
  const Matrix3d v = RefractedVergence(Matrix3d::Zero(), bend, in, out, 1, n);
  const double cos_i = std::cos(angle), cos_o = std::sqrt(1 - std::pow(std::sin(angle) / n, 2));
  const double sagittal = 1000 * (n * cos_o - cos_i) / r;
  EXPECT_NEAR(v(1, 1), sagittal, 1e-13);
  const Vector3d in_plane = Vector3d::UnitY().cross(out);
  EXPECT_NEAR(in_plane.dot(v * in_plane), sagittal / (cos_o * cos_o), 1e-12);
}

TEST(Propagated, ReachesInfinityAtAFocusAndComesBack) {
  const Wavefront wave = SphericalWave({{0, 0, 0}, {0, 0, 1}}, 8);
  EXPECT_FALSE(Propagated(wave, 125, 1).vergence_D.array().isNaN().any());
  EXPECT_NEAR(Propagated(wave, 62.5, 1).vergence_D(0, 0), 16, 1e-12);
  const Wavefront back = Propagated(Propagated(wave, 40, 1.5), -40, 1.5);
  EXPECT_LT((back.vergence_D - wave.vergence_D).norm(), 1e-13);
}

TEST(Coddington, ReversedPencilReturnsToItsSource) {
  std::mt19937_64 random(8);
  double worst = 0;
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const RandomLens made = MakeRandomLens(random);
    const Ray ray = MakeRandomRay(random);
    const auto there = TraceWavefront(made.lens, made.index, SphericalWave(ray, -2));
    if (there.status != RayStatus::kOk || there.exit.vergence_D.norm() > 40) continue;
    Wavefront back = there.exit;
    back.chief.direction = -back.chief.direction;
    back.vergence_D = -back.vergence_D;
    const auto home = TraceWavefront(made.lens, made.index, back);
    ASSERT_EQ(home.status, RayStatus::kOk);
    ++compared;
    const double reach = (ray.origin - home.exit.chief.origin).dot(-ray.direction);
    const Wavefront at_start = Propagated(home.exit, reach, 1);
    EXPECT_LT((home.exit.chief.direction + ray.direction).norm(), 1e-12);
    worst = std::max(worst, (at_start.vergence_D + SphericalWave(ray, -2).vergence_D).norm());
  }
  EXPECT_GT(compared, 1000);
  EXPECT_LT(worst, kCoddingtonAgreement_D);
}

}  // namespace
}  // namespace lorgnette
