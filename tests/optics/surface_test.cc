// SPDX-License-Identifier: Apache-2.0
#include "optics/surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>
#include <random>

#include "base/units.h"

namespace lorgnette {
namespace {

using Eigen::Vector3d;

constexpr double kSteep = 1 / 24.4;  // -20 D at n = 1.5 with a flat front: among the steepest worn

// Rounding of a closed-form intersection near the vertex, a few ulps of 50 mm.
constexpr double kIntersectError_mm = 2e-14;

std::vector<Surface> Zoo() {
  std::vector<Surface> zoo;
  for (const double c : {0.0, 1e-15, -1e-9, 1 / 300.0, -1 / 75.0, kSteep, -kSteep}) {
    zoo.push_back(SphereSurface{c});
    for (const double across : {0.0, 1 / 60.0, -1 / 90.0, c * (1 + 1e-9)}) {
      for (const double angle : {0.0, 0.7, kPi / 2, 2.5}) {
        zoo.push_back(TorusSurface{c, across, angle});
      }
    }
  }
  return zoo;
}

TEST(SurfaceJet, DerivativesAgreeWithDifferencesOfTheSag) {
  // Central differences at step h err by h^2 f'''/6 + eps f/h: below 1e-7 for sags of some mm.
  constexpr double kStep = 1e-4, kFirst = 1e-8, kSecond = 1e-7;
  for (const Surface& s : Zoo()) {
    for (const auto& [x, y] : {std::pair{3.0, -7.0}, {0.0, 0.0}, {-12.0, 5.0}}) {
      const auto jet = s.Jet(x, y);
      ASSERT_TRUE(jet);
      const SurfaceJet px = *s.Jet(x + kStep, y), mx = *s.Jet(x - kStep, y);
      const SurfaceJet py = *s.Jet(x, y + kStep), my = *s.Jet(x, y - kStep);
      EXPECT_NEAR(jet->zx, (px.z - mx.z) / (2 * kStep), kFirst);
      EXPECT_NEAR(jet->zy, (py.z - my.z) / (2 * kStep), kFirst);
      EXPECT_NEAR(jet->zxx, (px.zx - mx.zx) / (2 * kStep), kSecond);
      EXPECT_NEAR(jet->zyy, (py.zy - my.zy) / (2 * kStep), kSecond);
      EXPECT_NEAR(jet->zxy, (py.zx - my.zx) / (2 * kStep), kSecond);
      EXPECT_NEAR(jet->zxy, (px.zy - mx.zy) / (2 * kStep), kSecond);
    }
  }
}

TEST(SurfaceJet, IsAbsentWhereTheSphereEnds) {
  const Surface s = SphereSurface{1 / 20.0};
  EXPECT_TRUE(s.Jet(19.999, 0));
  EXPECT_FALSE(s.Jet(20, 0));
  EXPECT_FALSE(s.Jet(15, 15));
}

TEST(SurfaceJet, IsAbsentWhereTheTorusEnds) {
  const Surface s = TorusSurface{1 / 20.0, 1 / 40.0, 0};
  EXPECT_FALSE(s.Jet(20, 0));
  EXPECT_TRUE(s.Jet(0, 39));
  EXPECT_FALSE(s.Jet(0, 41));
}

TEST(Torus, HasTheStatedCurvaturesAtItsVertex) {
  const double angle = 0.4, g = 1 / 55.0, a = 1 / 75.0;
  const Eigen::Matrix2d k = Surface(TorusSurface{g, a, angle}).VertexCurvature();
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
  EXPECT_NEAR(along.dot(k * along), g, 1e-17);
  EXPECT_NEAR(across.dot(k * across), a, 1e-17);
  EXPECT_NEAR(along.dot(k * across), 0, 1e-17);
}

// Which circle generates matters: r = 60 and 90 mm at (20, 20) differ by 0.0507 mm.
TEST(Torus, GeneratorsDifferOffTheMeridians) {
  const Surface y_generates = TorusSurface{1 / 90.0, 1 / 60.0, kPi / 2};
  const Surface x_generates = TorusSurface{1 / 60.0, 1 / 90.0, 0};
  EXPECT_NEAR(std::abs(y_generates.Jet(20, 20)->z - x_generates.Jet(20, 20)->z), 0.0507, 5e-5);
  EXPECT_NEAR(y_generates.Jet(20, 0)->z, x_generates.Jet(20, 0)->z, 1e-14);
  EXPECT_NEAR(y_generates.Jet(0, 20)->z, x_generates.Jet(0, 20)->z, 1e-14);
}

TEST(Torus, WithEqualCurvaturesIsTheSphere) {
  const double c = 1 / 62.0;
  const Surface sphere = SphereSurface{c}, torus = TorusSurface{c, c, 1.1};
  const auto a = sphere.Jet(13, -21), b = torus.Jet(13, -21);
  EXPECT_NEAR(a->z, b->z, 1e-14);
  EXPECT_NEAR(a->zx, b->zx, 1e-15);
  EXPECT_NEAR(a->zxy, b->zxy, 1e-16);
  EXPECT_NEAR(a->zyy, b->zyy, 1e-16);
}

TEST(Intersect, PointsLieOnTheSurfaceAndOnTheRay) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> lateral(-18, 18), slope(-0.6, 0.6);
  double worst = 0;
  int hits = 0;
  for (const Surface& s : Zoo()) {
    for (int i = 0; i < 40; ++i) {
      const Vector3d aim(lateral(random), lateral(random), 0);
      Vector3d d(slope(random), slope(random), i % 2 ? 1 : -1);
      d.normalize();
      const auto hit = s.Intersect({aim - 40 * d, d});
      if (!hit) continue;
      ++hits;
      ASSERT_TRUE(hit->point.allFinite());
      const auto jet = s.Jet(hit->point.x(), hit->point.y());
      ASSERT_TRUE(jet);
      worst = std::max(worst, std::abs(jet->z - hit->point.z()));
      worst = std::max(worst, (aim + (hit->distance - 40) * d - hit->point).norm());
      EXPECT_NEAR(hit->normal.norm(), 1, 1e-15);
      EXPECT_GT(hit->normal.z(), 0);
      EXPECT_NEAR(hit->normal.x() / hit->normal.z(), -jet->zx, 1e-13);
    }
  }
  EXPECT_GT(hits, 4000);
  RecordProperty("worst_mm", std::to_string(worst));
  std::cout << "worst distance " << worst << " mm over " << hits << " hits\n";
  EXPECT_LT(worst, 3 * kIntersectError_mm);
}

// The centre form of a sphere errs by 1.2e-2 mm at 1e-12 D; the vertex form does not.
TEST(Intersect, StaysExactFromPlanoToSteep) {
  const Vector3d d = Vector3d(0.1, -0.2, 1).normalized();
  for (double power = 1e-12; power < 30; power *= 10) {
    for (const double sign : {-1.0, 1.0}) {
      const double c = sign * power / 1000 / 0.5;
      const auto hit = Surface(SphereSurface{c}).Intersect({Vector3d(5, 5, 0) - 20 * d, d});
      ASSERT_TRUE(hit);
      const long double cl = c, x = hit->point.x(), y = hit->point.y();
      const long double h2 = x * x + y * y;
      const long double z = cl * h2 / (1 + std::sqrt(1 - cl * cl * h2));
      EXPECT_LT(std::abs(double(z - hit->point.z())), 4e-15) << power;
    }
  }
}

TEST(Intersect, PlaneIsTheLimitOfTheSphere) {
  const Vector3d d = Vector3d(0.3, 0.1, 1).normalized();
  const Ray ray{Vector3d(1, 2, -10), d};
  const auto plane = Surface(SphereSurface{0}).Intersect(ray);
  const auto weak = Surface(SphereSurface{1e-18}).Intersect(ray);
  ASSERT_TRUE(plane && weak);
  EXPECT_LT((plane->point - weak->point).norm(), kIntersectError_mm);
}

TEST(Intersect, MissesBesideTheSphereAndParallelToThePlane) {
  EXPECT_FALSE(Surface(SphereSurface{1 / 20.0}).Intersect({{21, 0, -5}, {0, 0, 1}}));
  EXPECT_FALSE(Surface(SphereSurface{0}).Intersect({{0, 0, -5}, {1, 0, 0}}));
  EXPECT_FALSE(Surface(TorusSurface{1 / 20.0, 1 / 30.0, 0}).Intersect({{25, 0, -5}, {0, 0, 1}}));
}

// The far side of the sphere is nearer to a ray from behind; the sheet with the vertex is wanted.
TEST(Intersect, TakesTheSheetThatHoldsTheVertex) {
  const double r = 30;
  const auto hit = Surface(SphereSurface{1 / r}).Intersect({{0, 4, 100}, {0, 0, -1}});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->point.z(), r - std::sqrt(r * r - 16), kIntersectError_mm);
}

// At distance R(1 - delta) from the axis a ray along it grazes: still a hit; beyond R, none.
TEST(Intersect, DecidesGrazingRaysWithoutNan) {
  const double r = 20;
  for (double delta = 1e-3; delta > 1e-16; delta /= 10) {
    const auto in = Surface(SphereSurface{1 / r}).Intersect({{r * (1 - delta), 0, -9}, {0, 0, 1}});
    if (in) {
      EXPECT_TRUE(in->point.allFinite() && in->normal.allFinite());
    }
    if (delta > 1e-14) {
      EXPECT_TRUE(in) << delta;
    }
    const auto out = Surface(SphereSurface{1 / r}).Intersect({{r * (1 + delta), 0, -9}, {0, 0, 1}});
    if (delta > 1e-14) {
      EXPECT_FALSE(out) << delta;
    }
  }
}

// The quartic's double roots cost 1e-7 mm near the sphere; Newton on the sag costs nothing.
TEST(Intersect, NearSphericalTorusKeepsFullPrecision) {
  const Vector3d d = Vector3d(-0.2, 0.15, 1).normalized();
  for (const double other : {60.01, 60 + 1e-7, 60 + 1e-13, 60.0}) {
    const Surface s = TorusSurface{1 / 60.0, 1 / other, 0.3};
    const auto hit = s.Intersect({Vector3d(12, -9, 0) - 30 * d, d});
    ASSERT_TRUE(hit);
    EXPECT_NEAR((hit->point - (Vector3d(12, -9, 0) - 30 * d)).cross(d).norm(), 0,
                kIntersectError_mm);
  }
  const auto nearly = Surface(TorusSurface{1 / 60.0, 1 / (60 + 1e-13), 0.3})
                          .Intersect({Vector3d(12, -9, 0) - 30 * d, d});
  const auto sphere = Surface(SphereSurface{1 / 60.0}).Intersect({Vector3d(12, -9, 0) - 30 * d, d});
  EXPECT_LT((nearly->point - sphere->point).norm(), kIntersectError_mm);
}

// Starting points beyond the rim leave the domain of Newton's method; the scan must find the hit.
TEST(Intersect, SteepTorusIsFoundFromObliqueRays) {
  const Surface s = TorusSurface{1 / 22.0, 1 / 18.0, 0.2};
  int hits = 0;
  for (double slope = -3; slope <= 3; slope += 0.05) {
    const Vector3d d = Vector3d(slope, 0.3 * slope, 1).normalized();
    const double x = 9;
    const Vector3d target(x, -4, s.Jet(x, -4)->z);
    const auto hit = s.Intersect({target - 60 * d, d});
    // Of two crossings along a very oblique ray the other one may come first; each lies on it.
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(s.Jet(hit->point.x(), hit->point.y())->z, hit->point.z(), 1e-13);
  }
  EXPECT_GT(hits, 80);
}

}  // namespace
}  // namespace lorgnette
