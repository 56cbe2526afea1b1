// SPDX-License-Identifier: Apache-2.0
#include "optics/power_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optics/media.h"
#include "optics/paraxial.h"

namespace lorgnette {
namespace {

Lens Minus6() {
  Lens lens;
  lens.front = Surface(SphereSurface{2.0 / 600});
  lens.back = Surface(SphereSurface{8.00375704445836 / 600});
  lens.center_thickness_mm = 1.5;
  lens.medium = {"test", 1.6, 30, 1.3};
  return lens;
}

Lens Toric() {
  Lens lens = Minus6();
  lens.back = Surface(TorusSurface{1 / 54.47, 1 / 74.86, 0.5});
  return lens;
}

TEST(PowerMap, EqualsTheGazeEvaluatedPointByPoint) {
  const Lens lens = Toric();
  PowerMapOptions options;
  options.size = 15;
  const PowerMap map = MakePowerMap(lens, 1.6, options);
  const double reach = std::tan(RadiansFromDegrees(30));
  int compared = 0;
  for (int j = 0; j < map.size; ++j) {
    for (int i = 0; i < map.size; ++i) {
      const double x = -reach + 2 * reach * i / (map.size - 1);
      const double y = reach - 2 * reach * j / (map.size - 1);
      const MapPoint& point = map.at(i, j);
      if (std::hypot(x, y) > reach * (1 + 1e-9)) {
        EXPECT_EQ(point.status, RayStatus::kMissesSurface);
        continue;
      }
      const auto gaze = EvaluateGaze(lens, 1.6, EyePose::OnAxis(lens, 27),
                                     {std::atan(std::hypot(x, y)), std::atan2(y, x)});
      ASSERT_EQ(point.status, gaze.status);
      ++compared;
      const PowerVector expected = PowerVectorOfLensFrame(gaze.vergence_D);
      EXPECT_NEAR(point.power.mean, expected.mean, 1e-10);
      EXPECT_NEAR(point.power.j0, expected.j0, 1e-10);
      EXPECT_NEAR(point.power.j45, expected.j45, 1e-10);
      EXPECT_LT((point.front_mm - gaze.object_ray.origin.head<2>()).norm(), 1e-11);
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(PowerMap, CentreHasTheVertexPowerAndNothingElse) {
  PowerMapOptions options;
  options.size = 3;
  const MapPoint centre = MakePowerMap(Minus6(), 1.6, options).at(1, 1);
  EXPECT_NEAR(centre.power.mean, -6, 1e-12);
  EXPECT_NEAR(std::hypot(centre.power.j0, centre.power.j45), 0, 1e-13);
  EXPECT_EQ(centre.prism.norm(), 0);
  EXPECT_EQ(centre.distortion, 0);
  EXPECT_NEAR(centre.lateral_colour, 0, 1e-12);
}

TEST(PowerMap, PrismPointsAlongPrenticesRuleNearTheAxis) {
  // Base = -F r: a minus lens has its base outward. Gaze tangents of 0.01 cross 0.27 mm off centre.
  PowerMapOptions options;
  options.size = 3;
  options.half_angle_deg = DegreesFromRadians(std::atan(0.001));
  const PowerMap map = MakePowerMap(Minus6(), 1.6, options);
  // Exactly, to first order: 100 (alpha' - alpha0), with alpha0 from the inverse system.
  const auto s = ParaxialSystem::ThickLens(Diopters(2), Diopters(-8.00375704445836), 1.5, 1.6);
  const double alpha = 0.001, y2 = -0.027 * alpha;  // slopes of the light at the eye
  const double alpha0 = -s.c_D * y2 + s.a * alpha;  // inverse of a unimodular matrix
  const double expected = 100 * (alpha - alpha0);
  // Looking to +x: light slopes -x, so signs turn.
  EXPECT_NEAR(map.at(2, 1).prism.x(), -expected, 1e-6);  // third order: alpha^3
  EXPECT_GT(map.at(2, 1).prism.x(), 0);
  EXPECT_NEAR(map.at(2, 1).prism.y(), 0, 1e-12);
  EXPECT_GT(map.at(1, 0).prism.y(), 0);  // row 0 is up
  // Prentice on the thin lens: 0.6 prism D at 1 mm.
  EXPECT_NEAR(map.at(2, 1).prism.x(), 6 * 0.0027, 0.02 * 0.0162);
}

TEST(PowerMap, LateralColourIsPrismOverAbbeNumber) {
  PowerMapOptions options;
  options.size = 3;
  options.half_angle_deg = 10;
  const MapPoint edge = MakePowerMap(Minus6(), 1.6, options).at(2, 1);
  // Thin prism: deviation proportional to n - 1, so TCA = prism / V; thickness and the square of
  // the angle leave a few per cent.
  EXPECT_NEAR(edge.lateral_colour, edge.prism.norm() / 30, 0.05 * edge.prism.norm() / 30);
  options.lateral_colour = false;
  EXPECT_EQ(MakePowerMap(Minus6(), 1.6, options).at(2, 1).lateral_colour, 0);
}

TEST(PowerMap, PlusLensShowsPincushionAndMinusLensBarrelDistortion) {
  PowerMapOptions options;
  options.size = 3;
  // Object tangents grow faster than paraxial for minus lenses (the world looks compressed at the
  // rim: barrel), slower for plus lenses.
  EXPECT_GT(MakePowerMap(Minus6(), 1.6, options).at(2, 1).distortion, 0.01);
  Lens plus;
  plus.front = Surface(SphereSurface{9.0 / 600});
  plus.back = Surface(SphereSurface{3.3 / 600});
  plus.center_thickness_mm = 5;
  plus.medium.index_d = 1.6;
  EXPECT_LT(MakePowerMap(plus, 1.6, options).at(2, 1).distortion, -0.01);
}

TEST(PowerMap, PlanoPlateDoesNothingButShift) {
  Lens plate;
  plate.center_thickness_mm = 3;
  const MapSummary summary = Summarize(MakePowerMap(plate, 1.5));
  EXPECT_GT(summary.points, 7000);
  constexpr double kRounding = 1e-12;
  EXPECT_LT(summary.mean_power_D.greatest - summary.mean_power_D.least, kRounding);
  EXPECT_LT(summary.cylinder_D.greatest, kRounding);
  EXPECT_LT(summary.prism.greatest, kRounding);
  EXPECT_LT(std::abs(summary.distortion.greatest), kRounding);
}

TEST(PowerMap, CountsNoPointThatALensLoses) {
  Lens steep = Minus6();
  steep.back = Surface(SphereSurface{1 / 12.0});
  const PowerMap map = MakePowerMap(steep, 1.6);
  const MapSummary summary = Summarize(map);
  EXPECT_LT(summary.points, 7000);
  for (const MapPoint& point : map.points) {
    ASSERT_TRUE(std::isfinite(point.power.mean) && point.prism.allFinite());
  }
}

TEST(PowerMap, WorksOnSurfacesWithoutASimdForm) {
  ProgressiveSurface progressive(5.0 / 600, 2.0 / 600, 0, 14);
  Lens lens = Minus6();
  lens.front = Surface(progressive);
  PowerMapOptions options;
  options.size = 9;
  const PowerMap map = MakePowerMap(lens, 1.6, options);
  // Downward gaze (last row) meets the near zone: 2 D more.
  EXPECT_GT(map.at(4, 8).power.mean - map.at(4, 0).power.mean, 1.5);
}

}  // namespace
}  // namespace lorgnette
