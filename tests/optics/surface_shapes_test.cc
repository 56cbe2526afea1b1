// SPDX-License-Identifier: Apache-2.0
#include "optics/surface_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/units.h"
#include "optics/surface.h"

namespace lorgnette {
namespace {

// Mean power and cylinder of a front surface at a point, D.
struct LocalPower {
  double mean, cylinder;
};
LocalPower PowerAt(const Surface& s, double x, double y, double index) {
  const SurfaceJet j = *s.Jet(x, y);
  const double w = 1 + j.zx * j.zx + j.zy * j.zy;
  const double h =
      ((1 + j.zy * j.zy) * j.zxx - 2 * j.zx * j.zy * j.zxy + (1 + j.zx * j.zx) * j.zyy) /
      (2 * w * std::sqrt(w));
  const double k = (j.zxx * j.zyy - j.zxy * j.zxy) / (w * w);
  return {1000 * (index - 1) * h, 2000 * (index - 1) * std::sqrt(std::max(h * h - k, 0.0))};
}

ProgressiveSurface Golden(double angle = 0) {  // n = 1.6, B = 5, ADD = 2, y0 = 0, h = 14
  return ProgressiveSurface(5 / 600.0, 2 / 600.0, 0, 14, angle);
}

Surface CubicGrid() {
  Eigen::MatrixXd sag(21, 25);
  for (int i = 0; i < 21; ++i) {
    for (int j = 0; j < 25; ++j) {
      const double x = -20 + 2 * i, y = -24 + 2 * j;
      sag(i, j) = 1e-3 * x * x + 2e-3 * y * y + 1e-5 * x * x * y - 2e-5 * y * y * y;
    }
  }
  return GridSurface{std::make_shared<SplineGrid>(SplineGrid::Through(sag, -20, -24, 2, 2, 0))};
}

std::vector<Surface> Shapes() {
  return {ConicSurface{1 / 60.0, -1.7, {1e-7, -2e-10, 3e-13, -1e-16}},
          ConicSurface{-1 / 40.0, 2.5, {}},
          ConicSurface{0, 0, {2e-6, 0, 0, 0}},
          AtoroidSurface{1 / 60.0, 1 / 80.0, -0.8, 1.2, 2e-7, 0.6},
          AtoroidSurface{-1 / 50.0, 1 / 90.0, 0.5, 0, 0, 2.1},
          Golden(),
          Golden(0.17),
          ProgressiveSurface(0, 2 / 600.0, -3, 10),
          CubicGrid()};
}

TEST(SurfaceShapes, DerivativesAgreeWithDifferences) {
  constexpr double kStep = 1e-4, kFirst = 1e-8, kSecond = 1e-7;  // h^2 f''' / 6 and eps f / h
  for (const Surface& s : Shapes()) {
    for (const auto& [x, y] : {std::pair{3.0, -7.0}, {0.0, 0.0}, {-11.0, 5.0}, {6.0, -17.0}}) {
      const auto jet = s.Jet(x, y);
      ASSERT_TRUE(jet) << s.shape().index();
      const SurfaceJet px = *s.Jet(x + kStep, y), mx = *s.Jet(x - kStep, y);
      const SurfaceJet py = *s.Jet(x, y + kStep), my = *s.Jet(x, y - kStep);
      EXPECT_NEAR(jet->zx, (px.z - mx.z) / (2 * kStep), kFirst) << s.shape().index();
      EXPECT_NEAR(jet->zy, (py.z - my.z) / (2 * kStep), kFirst) << s.shape().index();
      EXPECT_NEAR(jet->zxx, (px.zx - mx.zx) / (2 * kStep), kSecond) << s.shape().index();
      EXPECT_NEAR(jet->zyy, (py.zy - my.zy) / (2 * kStep), kSecond) << s.shape().index();
      EXPECT_NEAR(jet->zxy, (py.zx - my.zx) / (2 * kStep), kSecond) << s.shape().index();
    }
  }
}

TEST(SurfaceShapes, RaysMeetThem) {
  const Eigen::Vector3d d = Eigen::Vector3d(0.15, -0.2, 1).normalized();
  for (const Surface& s : Shapes()) {
    for (double x = -12; x <= 12; x += 4) {
      const Eigen::Vector3d start = Eigen::Vector3d(x, 0.7 * x - 2, 0) - 25 * d;
      const auto hit = s.Intersect({start, d});
      ASSERT_TRUE(hit) << s.shape().index();
      EXPECT_LT((start + hit->distance * d - hit->point).norm(), 4e-14);
      EXPECT_NEAR(s.Jet(hit->point.x(), hit->point.y())->z, hit->point.z(), 1e-15);
    }
  }
}

TEST(Conic, WithoutTermsIsTheSphere) {
  const auto a = Surface(ConicSurface{1 / 70.0, 0, {}}).Jet(9, 14);
  const auto b = Surface(SphereSurface{1 / 70.0}).Jet(9, 14);
  EXPECT_NEAR(a->z, b->z, 1e-15);
  EXPECT_NEAR(a->zxx, b->zxx, 1e-17);
  EXPECT_NEAR(a->zxy, b->zxy, 1e-17);
}

// kappa_sagittal = c / e and kappa_tangential = c / e^3 with e = sqrt(1 - k c^2 h^2).
TEST(Conic, HasTheTwoCurvaturesOfItsFormula) {
  const double c = 1 / 55.0, k = -2.3, h = 17;
  const SurfaceJet j = *Surface(ConicSurface{c, k, {}}).Jet(0, h);
  const double e = std::sqrt(1 - k * c * c * h * h), w = std::sqrt(1 + j.zy * j.zy);
  EXPECT_NEAR(j.zyy / (w * w * w), c / (e * e * e), 1e-16);
  EXPECT_NEAR(j.zxx / w, c / e, 1e-16);
}

TEST(Conic, ParabolaHasNoRim) {
  EXPECT_NEAR(Surface(ConicSurface{1 / 20.0, -1, {}}).Jet(0, 80)->z, 160, 1e-12);
  EXPECT_FALSE(Surface(ConicSurface{1 / 20.0, 0, {}}).Jet(0, 80));
}

TEST(Atoroid, WithCircularSectionsIsTheTorus) {
  const auto a = Surface(AtoroidSurface{1 / 60.0, 1 / 85.0, 0, 0, 0, 0.4}).Jet(-13, 11);
  const auto b = Surface(TorusSurface{1 / 60.0, 1 / 85.0, 0.4}).Jet(-13, 11);
  EXPECT_NEAR(a->z, b->z, 1e-15);
  EXPECT_NEAR(a->zx, b->zx, 1e-16);
  EXPECT_NEAR(a->zyy, b->zyy, 1e-16);
}

// Section 11 of the reference, to its last digit.
TEST(Progressive, HasTheGoldenSagsAndPowers) {
  struct Row {
    double x, y, z, mean, cylinder;
  };
  const Surface s = Golden();
  for (const Row& row :
       {Row{0, -7, 0.210195588630, 6.0, 0}, Row{0, -3.5, 0.0512977029921, 5.20703125, 0},
        Row{2, -7, 0.230236125814, 5.99916277, 1.06924996},
        Row{5, -7, 0.335515047223, 5.99453289, 2.67149746},
        Row{10, -7, 0.712422306332, 5.97478866, 5.32948059},
        Row{5, -3.5, 0.159875922434, 5.56423786, 1.66706714}, Row{10, 10, 0.836247121870, 5, 0},
        Row{8, -20, 2.36415290303, 7, 0}, Row{15, -25, 4.58749330791, 7, 0}}) {
    EXPECT_NEAR(s.Jet(row.x, row.y)->z, row.z, 6e-12) << row.x << " " << row.y;
    const LocalPower p = PowerAt(s, row.x, row.y, 1.6);
    EXPECT_NEAR(p.mean, row.mean, 5.1e-9) << row.x << " " << row.y;
    // sqrt(H^2 - K) of an umbilic point is the square root of rounding, 1e-8 of 600 D mm * 0.01.
    EXPECT_NEAR(p.cylinder, row.cylinder, row.cylinder == 0 ? 1e-6 : 5.1e-9);
  }
}

// Minkwitz: beside the umbilic the cylinder grows twice as fast as the power along it.
TEST(Progressive, ObeysMinkwitz) {
  const double slope = PowerAt(Golden(), 0.01, -7, 1.6).cylinder / 0.01;
  EXPECT_NEAR(slope, 0.534684, 1e-5);
}

TEST(Progressive, TurnsForTheInset) {
  const double a = 0.17;
  const SurfaceJet own = *Surface(Golden()).Jet(4, -9);
  // The point (4, -9) of the upright surface, turned by `a` from +y toward -x.
  const double x = 4 * std::cos(a) + 9 * std::sin(a), y = 4 * std::sin(a) - 9 * std::cos(a);
  EXPECT_NEAR(Surface(Golden(a)).Jet(x, y)->z, own.z, 1e-14);
}

TEST(Grid, ReproducesACubicExactly) {
  const Surface s = CubicGrid();
  for (double x = -19.7; x < 20; x += 3.1) {
    for (double y = -23.5; y < 24; y += 3.7) {
      const SurfaceJet j = *s.Jet(x, y);
      EXPECT_NEAR(j.z, 1e-3 * x * x + 2e-3 * y * y + 1e-5 * x * x * y - 2e-5 * y * y * y, 1e-14);
      EXPECT_NEAR(j.zyy, 4e-3 - 1.2e-4 * y, 1e-14);
      EXPECT_NEAR(j.zxy, 2e-5 * x, 1e-14);
    }
  }
  EXPECT_FALSE(s.Jet(20.1, 0));
}

// A cubic spline's sag errs by h^4 z'''' (5/384 on one axis): 2 mm nodes on a 60 mm sphere.
TEST(Grid, FollowsASphere) {
  Eigen::MatrixXd sag(31, 31);
  for (int i = 0; i < 31; ++i) {
    for (int j = 0; j < 31; ++j) {
      sag(i, j) = Surface(SphereSurface{1 / 60.0}).Jet(-30 + 2 * i, -30 + 2 * j)->z;
    }
  }
  const auto spline = std::make_shared<SplineGrid>(SplineGrid::Through(sag, -30, -30, 2, 2, 0));
  const double fourth = 3 / (60.0 * 60 * 60) * 3;  // near the middle, with the mixed terms
  EXPECT_NEAR(Surface(GridSurface{spline}).Jet(7, 9)->z,
              Surface(SphereSurface{1 / 60.0}).Jet(7, 9)->z, 16 * fourth * 5 / 384);
}

}  // namespace
}  // namespace lorgnette
