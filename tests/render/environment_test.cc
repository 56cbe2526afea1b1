// SPDX-License-Identifier: Apache-2.0
#include "render/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "base/units.h"
#include "render/image_io.h"

namespace lorgnette {
namespace {

// One bright texel in a black map.
Environment OneTexel(int width, int height, int column, int row) {
  ImageRgbF map(width, height);
  map.at(column, row)[1] = 1;
  return Environment(std::move(map));
}

TEST(Environment, PutsTheImageCentreTowardTheCamera) {
  // With an odd number of rows and columns one texel's centre is the image's.
  EXPECT_NEAR(OneTexel(65, 33, 32, 16).Radiance({0, 0, 1}).y(), 1, 1e-3);
}

TEST(Environment, FollowsTheColumnAndRowRule) {
  constexpr int kWidth = 64, kHeight = 32;
  for (const int column : {0, 3, 15, 16, 33, 48, 63}) {
    for (const int row : {1, 8, 16, 30}) {
      const Environment environment = OneTexel(kWidth, kHeight, column, row);
      const double lon = 2 * kPi * ((column + 0.5) / kWidth - 0.5);
      const double lat = kPi * (0.5 - (row + 0.5) / kHeight);
      const Eigen::Vector3f d(float(-std::sin(lon) * std::cos(lat)), float(std::sin(lat)),
                              float(std::cos(lon) * std::cos(lat)));
      // The arc tangent is good to 2e-5 rad; a texel is 0.1 rad wide.
      EXPECT_NEAR(environment.Radiance(3 * d).y(), 1, 1e-3) << column << ", " << row;
      EXPECT_LT(environment.Radiance(-d).y(), 1e-3) << column << ", " << row;
      EXPECT_LT((environment.Direction(column + 0.5, row + 0.5) - d).norm(), 1e-6);
    }
  }
}

TEST(Environment, HasColumnsThatRunTowardMinusX) {
  // A quarter of the way past the centre: lon = 90 degrees, -x.
  const Environment environment = OneTexel(64, 32, 48, 16);
  const Eigen::Vector3f right_of_centre = environment.Direction(48.5, 16.5);
  EXPECT_LT(right_of_centre.x(), -0.9f);
  EXPECT_GT(environment.Radiance(right_of_centre).y(), 0.99f);
}

TEST(Environment, IsContinuousAcrossItsSeam) {
  ImageRgbF map(8, 4);
  for (int y = 0; y < 4; ++y) map.at(0, y)[0] = map.at(7, y)[0] = 1;
  const Environment environment(std::move(map));
  EXPECT_NEAR(environment.Radiance({1e-4f, 0, -1}).x(), 1, 1e-3);
  EXPECT_NEAR(environment.Radiance({-1e-4f, 0, -1}).x(), 1, 1e-3);
}

TEST(Environment, GivesAMeanOfDirectionsNotOfTexels) {
  // The upper quarter of the rows of 4 lies above 45 degrees: (1 - sin 45) / 2 of the sphere. The
  // row's weight is taken at its centre: cos 67.5 / (2 cos 67.5 + 2 cos 22.5).
  ImageRgbF map(4, 4);
  for (int x = 0; x < 4; ++x) map.at(x, 0)[2] = 1;
  const double weight = std::cos(RadiansFromDegrees(67.5));
  const double all = 2 * (weight + std::cos(RadiansFromDegrees(22.5)));
  EXPECT_NEAR(Environment(std::move(map)).Mean().z(), weight / all, 1e-6);
}

TEST(Environment, RefusesNanAndClampsNegative) {
  const std::string path = testing::TempDir() + "environment_test.exr";
  ImageRgbF map(4, 2);
  map.at(1, 1)[0] = -2;
  ASSERT_TRUE(WriteExr(map, path));
  std::string warning;
  const auto clamped = Environment::Read(path, &warning);
  ASSERT_TRUE(clamped);
  EXPECT_EQ(clamped->map().at(1, 1)[0], 0);
  EXPECT_NE(warning.find("1 negative"), std::string::npos) << warning;

  map.at(2, 0)[1] = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(WriteExr(map, path, ExrDepth::kFloat));
  const auto broken = Environment::Read(path);
  ASSERT_FALSE(broken);
  EXPECT_NE(broken.error().message.find("(2, 0)"), std::string::npos) << broken.error().message;
  std::filesystem::remove(path);
}

TEST(BlurredEnvironment, KeepsAConstant) {
  const Environment constant = Environment::Constant({0.5f, 1, 2});
  for (const auto& blurred :
       {BlurredEnvironment::ForCells(constant, 1024), BlurredEnvironment::ForPhong(constant, 20)}) {
    for (const Eigen::Vector3f& d : {Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(-1, 2, -0.3f),
                                     Eigen::Vector3f(0, 0, -1), Eigen::Vector3f(0.2f, -1, 0.1f)}) {
      // Means of equal numbers in single precision.
      EXPECT_LT((blurred.Radiance(d) - Eigen::Vector3f(0.5f, 1, 2)).norm(), 1e-4f);
    }
  }
}

TEST(BlurredEnvironment, KeepsTheLightOfASmallLamp) {
  // A lamp of 4 x 4 texels in 128 x 64: what it sends is its solid angle times its radiance,
  // however the map is blurred.
  ImageRgbF map(128, 64);
  for (int y = 20; y < 24; ++y) {
    for (int x = 40; x < 44; ++x) map.at(x, y)[0] = 100;
  }
  const Environment environment(std::move(map));
  const BlurredEnvironment blurred = BlurredEnvironment::ForCells(environment, 512);
  double sum = 0, weight = 0;
  constexpr int kRows = 180;
  for (int y = 0; y < kRows; ++y) {
    const double lat = kPi * (0.5 - (y + 0.5) / kRows);
    for (int x = 0; x < 2 * kRows; ++x) {
      const double lon = 2 * kPi * ((x + 0.5) / (2 * kRows) - 0.5);
      const Eigen::Vector3d d(-std::sin(lon) * std::cos(lat), std::sin(lat),
                              std::cos(lon) * std::cos(lat));
      sum += std::cos(lat) * double(blurred.Radiance(d.cast<float>()).x());
      weight += std::cos(lat);
    }
  }
  // 4 per cent: the kernel is normalised by what it finds on the reduced map, texel by texel.
  EXPECT_NEAR(sum / weight / double(environment.Mean().x()), 1, 0.04);
}

}  // namespace
}  // namespace lorgnette
