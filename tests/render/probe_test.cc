// SPDX-License-Identifier: Apache-2.0
#include "render/probe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/units.h"
#include "render/color.h"
#include "render/environment.h"
#include "render/exposure_tags.h"

namespace lorgnette {
namespace {

// A room: smooth light of three colours, and a lamp 30 times as bright as white.
Eigen::Vector3d Room(const Eigen::Vector3d& d) {
  Eigen::Vector3d light(0.25 + 0.15 * d.x(), 0.2 + 0.1 * d.y(), 0.2 - 0.1 * d.x() * d.y());
  if (d.dot(Eigen::Vector3d(0.5, 0.6, 0.6).normalized()) > 0.985) light.setConstant(30);
  return light;
}

// A photograph of a unit ball at `distance` radii, its outline at (x, y) with `radius` pixels, on a
// carpet of grain.
ImageRgb8 Photograph(int width, int height, double x, double y, double radius, double distance,
                     double exposure) {
  ImageRgb8 picture(width, height);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> grain(0.3, 0.6);
  const double edge = 1 / std::sqrt(distance * distance - 1);  // tangent of the outline
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      const Eigen::Vector3d carpet = Eigen::Vector3d(1, 0.9, 0.7) * grain(random);
      for (int s = 0; s < 9; ++s) {
        const double px = (column + (s % 3 + 0.5) / 3 - x) / radius;
        const double py = -(row + (s / 3 + 0.5) / 3 - y) / radius;
        // Camera at the origin looking along -z; the ball's centre at -distance.
        const Eigen::Vector3d d = Eigen::Vector3d(px * edge, py * edge, -1).normalized();
        const double b = -distance * d.z();
        const double under = b * b - distance * distance + 1;
        if (under < 0) {
          sum += carpet / 9;
          continue;
        }
        const Eigen::Vector3d n = (b - std::sqrt(under)) * d + Eigen::Vector3d(0, 0, distance);
        sum += Room(d - 2 * d.dot(n) * n) / 9;
      }
      for (int c = 0; c < 3; ++c) {
        picture.at(column, row)[c] = CodeFromLinear(float(std::min(1.0, exposure * sum[c])));
      }
    }
  }
  return picture;
}

TEST(FindBall, FindsTheOutlineAlsoWhereThePictureCutsIt) {
  for (const auto& [x, y, r] : {std::array{130.0, 115.0, 92.0}, std::array{120.3, 95.5, 104.0},
                                std::array{160.0, 120.0, 50.0}}) {
    const auto ball = FindBall(Photograph(260, 230, x, y, r, 8, 1));
    ASSERT_TRUE(ball) << r;
    // One pixel and a half: the outline is a step of one pixel, on a carpet of grain.
    EXPECT_NEAR(ball->x, x, 1.5);
    EXPECT_NEAR(ball->y, y, 1.5);
    EXPECT_NEAR(ball->radius, r, 1.5);
  }
}

TEST(FindBall, FindsNoneInGrainOrStripes) {
  ImageRgb8 grain(200, 160), stripes(200, 160);
  std::mt19937 random(2);
  for (std::uint8_t& v : grain.data) v = std::uint8_t(random() % 256);
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      for (int c = 0; c < 3; ++c) stripes.at(x, y)[c] = std::uint8_t(x / 17 % 2 == 0 ? 40 : 200);
    }
  }
  EXPECT_FALSE(FindBall(grain));
  EXPECT_FALSE(FindBall(stripes));
  const auto nothing = EnvironmentFromBall({{"grain", grain, 1}}, {});
  ASSERT_FALSE(nothing);
  EXPECT_NE(nothing.error().message.find("no ball"), std::string::npos);
}

TEST(EnvironmentFromBall, GivesBackTheRoomAndItsLamp) {
  constexpr double kDistance = 6;
  std::vector<ProbePhoto> photos;
  const double times[] = {1, 0.25, 1.0 / 64};
  for (int i = 0; i < 3; ++i) {
    // The hand moved between the photographs.
    photos.push_back({"photo",
                      Photograph(300, 280, 150 + 4 * i, 140 - 3 * i, 118, kDistance, times[i]),
                      times[i]});
  }
  ProbeOptions options;
  options.width = 128;
  options.distance_radii = kDistance;
  const auto probe = EnvironmentFromBall(photos, options);
  ASSERT_TRUE(probe) << probe.error().message;
  const Environment found(probe->map);
  double worst = 0, sum = 0, lamp = 0;
  int count = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 128; ++x) {
      const Eigen::Vector3d d = found.Direction(x + 0.5, y + 0.5).cast<double>();
      const double toward_lamp = d.dot(Eigen::Vector3d(0.5, 0.6, 0.6).normalized());
      const Eigen::Vector3d light =
          Eigen::Map<const Eigen::Vector3f>(probe->map.at(x, y)).cast<double>();
      if (toward_lamp > 0.992) lamp = std::max(lamp, light.x());
      // Beside the lamp's edge and the ball's, whose pixels are mixtures.
      if (toward_lamp > 0.94 || d.z() < -0.85) continue;
      const double error = (light - Room(d)).cwiseAbs().maxCoeff();
      worst = std::max(worst, error);
      sum += error;
      ++count;
    }
  }
  // Two pixels of 118 turn the mirrored direction by 0.07 rad at most away from the rim, where the
  // light changes by 0.15 a radian; code values add 0.005.
  EXPECT_LT(sum / count, 0.012);
  EXPECT_LT(worst, 0.06);
  // Only the shortest exposure shows it unclipped, at half of its range.
  EXPECT_NEAR(lamp, 30, 2);
  EXPECT_LT(probe->clipped, 0.001);
}

TEST(EnvironmentFromBall, ClosesBehindTheBallAndAtTheSeam) {
  ProbeOptions options;
  options.width = 128;
  const auto probe =
      EnvironmentFromBall({{"one", Photograph(260, 250, 130, 125, 110, 50, 1), 0}}, options);
  ASSERT_TRUE(probe) << probe.error().message;
  const Environment found(probe->map);
  // Straight behind is one colour from every side.
  for (const double a : {0.0, 1.5, 3.0, 4.5}) {
    const Eigen::Vector3f beside =
        found.Radiance({float(0.02 * std::cos(a)), float(0.02 * std::sin(a)), -1});
    EXPECT_LT((beside - found.Radiance({0, 0, -1})).cwiseAbs().maxCoeff(), 0.03f);
  }
  for (int y = 0; y < 64; ++y) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(probe->map.at(0, y)[c], probe->map.at(127, y)[c], 0.06f);
    }
  }
}

TEST(MirroredAngle, IsThatOfAFarCameraInTheLimit) {
  for (const double rho : {0.0, 0.3, 0.7, 0.99}) {
    EXPECT_NEAR(MirroredAngle(rho, 0), 2 * std::asin(rho), 1e-12);
    // The outline of a ball at d radii differs from the far one by 1 / d^2, the view by rho / d.
    EXPECT_NEAR(MirroredAngle(rho, 1000), 2 * std::asin(rho), 0.01);
  }
  // The rim shows what lies behind, past the ball.
  EXPECT_NEAR(MirroredAngle(1, 5), kPi - std::asin(1.0 / 5), 1e-6);
}

TEST(EnvironmentFromBall, WantsATimeForEachOfSeveralPhotographs) {
  const ImageRgb8 photo = Photograph(120, 110, 60, 55, 45, 8, 1);
  const auto probe = EnvironmentFromBall({{"a.png", photo, 1}, {"b.png", photo, 0}}, {});
  ASSERT_FALSE(probe);
  EXPECT_NE(probe.error().message.find("b.png"), std::string::npos);
}

}  // namespace
}  // namespace lorgnette
