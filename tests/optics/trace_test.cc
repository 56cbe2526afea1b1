// SPDX-License-Identifier: Apache-2.0
#include "optics/trace.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "base/units.h"

namespace lorgnette {
namespace {

using Eigen::Vector3d;

constexpr double kUnit = 4e-16;  // rounding of a unit vector's component

Lens MinusSix() {  // C1: n = 1.6, F1 = +2, t = 1.5, back vertex power -6 D
  Lens lens;
  lens.medium.index_d = 1.6;
  lens.center_thickness_mm = 1.5;
  lens.front = SphereSurface{1 / 300.0};
  lens.back = SphereSurface{1 / 74.9647942419027};
  return lens;
}

TEST(Refract, ObeysSnellInThePlaneOfIncidence) {
  for (double i = 0; i < 89; i += 3) {
    const double a = RadiansFromDegrees(i);
    const auto out = Refract({std::sin(a), 0, std::cos(a)}, {0, 0, 1}, 1 / 1.6);
    ASSERT_TRUE(out);
    EXPECT_NEAR(out->x(), std::sin(a) / 1.6, kUnit);
    EXPECT_NEAR(out->norm(), 1, kUnit);
  }
}

TEST(Refract, IsExactlyTheSameForBothSignsOfTheNormal) {
  const Vector3d d = Vector3d(0.2, -0.5, 1).normalized(), n = Vector3d(0.1, 0.3, 1).normalized();
  EXPECT_EQ(Refract(d, n, 1 / 1.5).value(), Refract(d, -n, 1 / 1.5).value());
}

TEST(Refract, IsReversible) {
  const Vector3d d = Vector3d(0.2, -0.5, 1).normalized(), n = Vector3d(0.1, 0.3, 1).normalized();
  const auto in = Refract(d, n, 1 / 1.74);
  const auto back = Refract(-*in, n, 1.74);
  EXPECT_LT((*back + d).norm(), 4 * kUnit);
}

TEST(Refract, GoesStraightBetweenEqualMedia) {
  const Vector3d d = Vector3d(0.7, -0.5, 0.1).normalized(), n = Vector3d(0.1, 0.3, 1).normalized();
  EXPECT_EQ(*Refract(d, n, 1.0), d);
}

// The critical angle of index 1.74 is asin(1/1.74) = 35.1 degrees; approach it from both sides.
TEST(Refract, ReturnsNulloptPastCriticalAngle) {
  const double critical = std::asin(1 / 1.74);
  for (double delta = 1e-2; delta > 1e-14; delta /= 10) {
    const double below = critical - delta, above = critical + delta;
    const auto out = Refract({std::sin(below), 0, std::cos(below)}, {0, 0, 1}, 1.74);
    ASSERT_TRUE(out) << delta;
    EXPECT_TRUE(out->allFinite());
    EXPECT_FALSE(Refract({std::sin(above), 0, std::cos(above)}, {0, 0, 1}, 1.74)) << delta;
  }
}

TEST(Reflect, KeepsTheTangentAndTurnsTheNormal) {
  const Vector3d out = Reflect(Vector3d(0.6, 0, 0.8), Vector3d(0, 0, -1));
  EXPECT_LT((out - Vector3d(0.6, 0, -0.8)).norm(), kUnit);
}

TEST(Fresnel, HasTheClosedFormsAtItsEnds) {
  for (const double n : {1.498, 1.5, 1.523, 1.6, 1.74}) {
    const double r = (n - 1) / (n + 1);
    EXPECT_NEAR(FresnelReflectance(1, 1 / n), r * r, kUnit);
    EXPECT_NEAR(FresnelReflectance(1, n), r * r, kUnit);
    EXPECT_EQ(FresnelReflectance(0, 1 / n), 1);
    EXPECT_EQ(FresnelReflectance(std::cos(std::asin(1 / n) + 1e-6), n), 1);
  }
  EXPECT_EQ(FresnelReflectance(0.3, 1), 0);
  EXPECT_EQ(FresnelReflectance(0, 1), 0);
}

TEST(Fresnel, IsTheSameFromEitherSideOfTheInterface) {
  for (double i = 0; i < 89; i += 7) {
    const double ci = std::cos(RadiansFromDegrees(i));
    const double inside = std::sqrt(1 - (1 - ci * ci) / (1.6 * 1.6));
    EXPECT_NEAR(FresnelReflectance(ci, 1 / 1.6), FresnelReflectance(inside, 1.6), 1e-14);
  }
}

TEST(TraceThrough, ParallelPencilFocusesAtTheBackFocalLength) {
  const double h = 1e-3;  // third-order aberration of the focus goes as h^2: 1e-8 relative
  const LensTrace trace = TraceThrough(MinusSix(), {{0, h, -5}, {0, 0, 1}});
  ASSERT_EQ(trace.status, RayStatus::kOk);
  const Ray& out = trace.exit;
  const double focus = out.origin.z() - out.origin.y() * out.direction.z() / out.direction.y();
  EXPECT_NEAR(focus - 1.5, -1000 / 6.0, 1e-6 * 1000 / 6);
}

TEST(TraceThrough, ReversedRayReturnsToItsStart) {
  constexpr double kReturn_mm = 1e-12;
  Lens toric = MinusSix();
  toric.back = TorusSurface{1 / 54.5, 1 / 74.9, 0.9};
  Lens ground = toric;
  ground.back_tilt_x = 0.05;
  ground.back_tilt_y = -0.03;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> lateral(-15, 15), slope(-0.3, 0.3);
  double worst = 0;
  for (const Lens& lens : {MinusSix(), toric, ground}) {
    for (int i = 0; i < 500; ++i) {
      const Vector3d start(lateral(random), lateral(random), -20);
      const Vector3d d = Vector3d(slope(random), slope(random), 1).normalized();
      const LensTrace there = TraceThrough(lens, {start, d});
      if (there.status != RayStatus::kOk) continue;
      const LensTrace back = TraceThrough(
          lens, {there.exit.origin + 30 * there.exit.direction, -there.exit.direction});
      ASSERT_EQ(back.status, RayStatus::kOk);
      const Vector3d again = back.exit.origin + (start.z() - back.exit.origin.z()) /
                                                    back.exit.direction.z() * back.exit.direction;
      worst = std::max(worst, (again - start).norm());
    }
  }
  EXPECT_LT(worst, kReturn_mm);
}

TEST(TraceThrough, LensOfIndexOneLeavesRaysAlone) {
  Lens lens = MinusSix();
  lens.back_tilt_x = 0.1;
  const Vector3d d = Vector3d(0.2, -0.1, 1).normalized();
  const LensTrace trace = TraceThrough(lens, {{3, 4, -10}, d}, 1.0);
  ASSERT_EQ(trace.status, RayStatus::kOk);
  EXPECT_LT((trace.exit.direction - d).norm(), kUnit);
  EXPECT_LT((trace.exit.origin - Vector3d(3, 4, -10)).cross(d).norm(), 1e-14);
}

TEST(TraceThrough, SaysWhyARayIsLost) {
  const Lens lens = MinusSix();
  EXPECT_EQ(TraceThrough(lens, {{400, 0, -5}, {0, 0, 1}}).status, RayStatus::kMissesSurface);
  Lens thick = lens;  // a wedge of 60 degrees: the critical angle inside is 38.7
  thick.front = SphereSurface{0};
  thick.back = SphereSurface{0};
  thick.back_tilt_x = RadiansFromDegrees(60);
  EXPECT_EQ(TraceThrough(thick, {{0, 0, -5}, {0, 0, 1}}).status,
            RayStatus::kTotalInternalReflection);
}

// A plane wedge: the tilted back is exact, so the deviation is Snell's own.
TEST(TraceThrough, TiltedBackSurfaceDeviatesAsAWedge) {
  Lens wedge;
  wedge.medium.index_d = 1.6;
  wedge.center_thickness_mm = 3;
  wedge.back_tilt_y = 0.04;
  const LensTrace trace = TraceThrough(wedge, {{2, 1, -5}, {0, 0, 1}});
  ASSERT_EQ(trace.status, RayStatus::kOk);
  const double deviation = std::asin(1.6 * std::sin(0.04)) - 0.04;
  EXPECT_NEAR(std::atan2(trace.exit.direction.x(), trace.exit.direction.z()), -deviation, 1e-15);
  EXPECT_NEAR(trace.exit.origin.z(), 3 - 2 * std::tan(0.04), 1e-14);
}

}  // namespace
}  // namespace lorgnette
