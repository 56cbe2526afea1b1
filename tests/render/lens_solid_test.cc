// SPDX-License-Identifier: Apache-2.0
#include "render/lens_solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "optics/trace.h"
#include "tests/render/render_test_scene.h"

namespace lorgnette {
namespace {

using test::LensRecipe;

TEST(ContourIndex, AgreesWithTheEllipseAboutInside) {
  const ContourIndex contour(test::Ellipse(50, 38, 720));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(-30, 30), y(-24, 24);
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector2d p(x(random), y(random));
    const double level = std::hypot(p.x() / 25, p.y() / 19);
    // The polygon lies inside the ellipse by at most 1 - cos(pi / 720) = 9.5e-6 of its radius.
    if (std::abs(level - 1) < 2e-5) continue;
    EXPECT_EQ(contour.Contains(p.x(), p.y()), level < 1) << p.transpose();
    // Bounds: never more than the distance along any line to the ellipse.
    const double radial = std::abs(level - 1) * p.norm() / level;
    EXPECT_LE(contour.Clearance(p.x(), p.y()), level < 1 ? radial + 1e-6 : 0);
    EXPECT_LE(contour.OutsideBy(p.x(), p.y()), level > 1 ? radial + 1e-3 : 0);
  }
}

// Against every edge of a star, whose concave outline most lines cross several times.
TEST(ContourIndex, FindsTheNearestCrossingOfAnyLine) {
  std::vector<Eigen::Vector2d> star;
  for (int i = 0; i < 150; ++i) {
    const double angle = 2 * kPi * i / 150, radius = 20 + 6 * std::cos(9 * angle);
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  const ContourIndex index(star);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-30, 30);
  int crossings = 0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector2d p(place(random), place(random));
    const Eigen::Vector2d d = 0.05 * Eigen::Vector2d(place(random), place(random));
    const double t_min = i % 3 == 0 ? 3 : 0, t_max = i % 5 == 0 ? 20 : 1e9;
    double nearest = t_max;
    for (std::size_t k = 0; k < star.size(); ++k) {
      const Eigen::Vector2d a = star[k], ab = star[(k + 1) % star.size()] - a;
      const double across = d.x() * ab.y() - d.y() * ab.x();
      const double t = ((a - p).x() * ab.y() - (a - p).y() * ab.x()) / across;
      const double s = ((a - p).x() * d.y() - (a - p).y() * d.x()) / across;
      if (s >= 0 && s < 1 && t > t_min && t < nearest) nearest = t;
    }
    const auto found = index.FirstCrossing(p, d, t_min, t_max);
    ASSERT_EQ(found.has_value(), nearest < t_max) << i;
    // Both are quotients of cross products of some 1e3 mm^2 with errors of a few units.
    if (found) {
      EXPECT_NEAR(found->t, nearest, 1e-9 * (1 + nearest));
    }
    crossings += found.has_value();
    // Inside, by the edges that a line to the right crosses: in a quarter of the draws close to
    // one, in cells that it crosses.
    const Eigen::Vector2d& corner = star[std::size_t(i) % star.size()];
    const Eigen::Vector2d q = i % 4 == 0 ? Eigen::Vector2d(corner + 0.01 * p) : p;
    bool inside = false;
    for (std::size_t k = 0; k < star.size(); ++k) {
      const Eigen::Vector2d &a = star[k], &b = star[(k + 1) % star.size()];
      if ((a.y() > q.y()) == (b.y() > q.y())) continue;
      inside ^= q.x() < a.x() + (q.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    }
    EXPECT_EQ(index.Contains(q.x(), q.y()), inside) << q.transpose();
    const ContourIndex::Place at = index.Locate(p.x(), p.y());
    EXPECT_EQ(at.inside, index.Contains(p.x(), p.y()));
    EXPECT_EQ(at.clearance, index.Clearance(p.x(), p.y()));
  }
  EXPECT_GT(crossings, 1000);
}

TEST(ContourIndex, FindsWhereALineLeaves) {
  const ContourIndex square({{-10, -10}, {10, -10}, {10, 10}, {-10, 10}});
  const auto crossing = square.FirstCrossing({0, 1}, {2, 0}, 0, 100);
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->t, 5, 1e-12);
  EXPECT_GT(crossing->normal.x(), 0.7);
  EXPECT_FALSE(square.FirstCrossing({0, 1}, {2, 0}, 0, 4.9));
  EXPECT_FALSE(square.FirstCrossing({20, 1}, {2, 0}, 0, 100));
}

class LensSolidOf : public testing::TestWithParam<LensRecipe> {
 protected:
  LensSolidOf()
      : lens_(test::MakeLens(GetParam()).lens()),
        solid_(lens_, test::Ellipse(GetParam().width_mm, GetParam().height_mm),
               Eigen::Isometry3d::Identity()) {}
  Lens lens_;
  LensSolid solid_;
};

TEST_P(LensSolidOf, LetsARayThroughAsTheReferenceTraceDoes) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> across(-0.6, 0.6), slope(-0.25, 0.25);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d target(across(random) * 24, across(random) * 18, 0);
    const Eigen::Vector3d d = Eigen::Vector3d(slope(random), slope(random), 1).normalized();
    const Ray ray{target - 500 * d, d};
    const LensTrace reference = TraceThrough(lens_, ray);
    ASSERT_EQ(reference.status, RayStatus::kOk);
    const auto enter = solid_.Enter(ray);
    ASSERT_TRUE(enter);
    EXPECT_EQ(enter->face, SolidFace::kFront);
    // 500 mm away a double has 1e-13 mm; both take a different route there.
    EXPECT_LT((enter->point - reference.first.point).norm(), 1e-11);
    const Ray inside{enter->point, reference.inside_direction};
    const auto leave = solid_.Leave(inside);
    ASSERT_TRUE(leave);
    EXPECT_EQ(leave->face, SolidFace::kBack);
    EXPECT_LT((leave->point - reference.second.point).norm(), 1e-11);
    EXPECT_GT(leave->normal.dot(inside.direction), 0);
  }
}

TEST_P(LensSolidOf, LetsNoRayStayInside) {
  std::mt19937 random(3);
  std::normal_distribution<double> gauss;
  int walls = 0, backs = 0, fronts = 0;
  for (int i = 0; i < 3000; ++i) {
    // From the middle of the glass above a point of the contour's inside, in any direction.
    const double r = std::sqrt(std::uniform_real_distribution<double>(0, 0.95)(random));
    const double angle = std::uniform_real_distribution<double>(0, 2 * kPi)(random);
    const double x = r * 0.5 * GetParam().width_mm * std::cos(angle);
    const double y = r * 0.5 * GetParam().height_mm * std::sin(angle);
    const double front = lens_.front.Jet(x, y)->z;
    const double back = lens_.center_thickness_mm + lens_.back.Jet(x, y)->z;
    Ray ray{{x, y, 0.5 * (front + back)},
            Eigen::Vector3d(gauss(random), gauss(random), gauss(random)).normalized()};
    for (int bounce = 0; bounce < 4; ++bounce) {
      const auto hit = solid_.Leave(ray);
      ASSERT_TRUE(hit) << i << " after " << bounce << ": " << ray.origin.transpose() << " toward "
                       << ray.direction.transpose();
      EXPECT_GT(hit->normal.dot(ray.direction), 0);
      walls += hit->face == SolidFace::kWall;
      fronts += hit->face == SolidFace::kFront;
      backs += hit->face == SolidFace::kBack;
      // Just past the boundary the ray is outside: it may come back, but not at once.
      const auto again = solid_.Enter({hit->point, ray.direction});
      if (again) {
        EXPECT_GT(again->distance, 1e-4);
      }
      ray = {hit->point, Reflect(ray.direction, hit->normal)};
    }
  }
  EXPECT_GT(walls, 100);
  EXPECT_GT(fronts, 100);
  EXPECT_GT(backs, 100);
}

TEST_P(LensSolidOf, IsMissedBesideItsContour) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> across(-40, 40);
  for (int i = 0; i < 2000; ++i) {
    const double x = across(random), y = across(random);
    const auto hit = solid_.Enter({{x, y, -50}, {0, 0, 1}});
    EXPECT_EQ(hit.has_value(), solid_.contour().Contains(x, y)) << x << ", " << y;
  }
}

TEST_P(LensSolidOf, IsEnteredThroughItsWallFromTheSide) {
  const double z =
      0.5 * (lens_.front.Jet(0.499 * GetParam().width_mm, 0)->z + lens_.center_thickness_mm +
             lens_.back.Jet(0.499 * GetParam().width_mm, 0)->z);
  const auto hit = solid_.Enter({{100, 0.3, z}, {-1, 0, 0}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->face, SolidFace::kWall);
  EXPECT_NEAR(hit->point.x(), 0.5 * GetParam().width_mm, 0.05);
  EXPECT_GT(hit->normal.x(), 0.9);
}

INSTANTIATE_TEST_SUITE_P(Recipes, LensSolidOf,
                         testing::Values(LensRecipe{-6, 0, 0, 1.6}, LensRecipe{5, 0, 0, 1.5},
                                         LensRecipe{-4.25, -0.75, 160, 1.6},
                                         LensRecipe{-12, -2, 30, 1.74}, LensRecipe{0, 0, 0, 1.5}));

}  // namespace
}  // namespace lorgnette
