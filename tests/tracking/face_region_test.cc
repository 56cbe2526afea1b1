// SPDX-License-Identifier: Apache-2.0
#include "tracking/face_region.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "base/units.h"

namespace lorgnette {
namespace {

TEST(FaceRegion, MapsThereAndBack) {
  const FaceRegion region{{320, 200}, 150, 0.4};
  const Eigen::Vector2d uv(0.2, 0.9);
  EXPECT_TRUE(region.FromImage(region.ToImage(uv)).isApprox(uv, 1e-12));
  EXPECT_TRUE(region.ToImage({0.5, 0.5}).isApprox(region.centre, 1e-12));
}

TEST(RegionAround, StandsUprightAlongTheEyes) {
  const double roll = 0.3;
  const Eigen::Rotation2Dd turn(roll);
  std::vector<Eigen::Vector2d> points;
  for (const double x : {-50.0, 50.0}) {
    for (const double y : {-80.0, 60.0}) points.push_back(turn * Eigen::Vector2d(x, y));
  }
  const FaceRegion region =
      RegionAround(points, turn * Eigen::Vector2d(-30, 0), turn * Eigen::Vector2d(30, 0));
  EXPECT_NEAR(region.angle, roll, 1e-12);
  EXPECT_NEAR(region.side, 1.5 * 140, 1e-9);
  EXPECT_LT((region.centre - turn * Eigen::Vector2d(0, -10)).norm(), 1e-9);
}

// A picture whose red and green channels say where they are.
ImageRgb8 Ramp() {
  ImageRgb8 image(250, 250);
  for (int y = 0; y < 250; ++y) {
    for (int x = 0; x < 250; ++x) {
      image.at(x, y)[0] = std::uint8_t(x);
      image.at(x, y)[1] = std::uint8_t(y);
    }
  }
  return image;
}

TEST(SampleRegion, PutsEveryPixelWhereTheRegionSays) {
  for (const double side : {60.0, 200.0}) {  // magnified and, by area, reduced
    const FaceRegion region{{125, 120}, side, 0.2};
    const ImageRgb8 sampled = SampleRegion(Ramp(), region, 64);
    for (const int x : {5, 31, 60}) {
      for (const int y : {9, 33, 50}) {
        const Eigen::Vector2d at = region.ToImage({(x + 0.5) / 64, (y + 0.5) / 64});
        // The value at position p is p - 0.5; rounding twice and OpenCV's 1/32 px steps.
        EXPECT_NEAR(sampled.at(x, y)[0], at.x() - 0.5, 1.1);
        EXPECT_NEAR(sampled.at(x, y)[1], at.y() - 0.5, 1.1);
      }
    }
  }
}

TEST(SampleRegion, IsBlackOutsideTheImage) {
  const ImageRgb8 sampled = SampleRegion(Ramp(), {{-500, -500}, 100, 0}, 16);
  for (const std::uint8_t v : sampled.data) EXPECT_EQ(v, 0);
}

}  // namespace
}  // namespace lorgnette
