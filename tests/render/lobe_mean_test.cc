// SPDX-License-Identifier: Apache-2.0
#include "render/lobe_mean.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <random>

#include "base/image.h"

namespace lorgnette {
namespace {

// A map of random light, and the same as what lobes read.
struct Light {
  ImageRgbF map{36, 18};
  LobeSource source;
  Light() {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> light(0, 2);
    for (float& v : map.data) v = light(random);
    source.width = map.width;
    source.columns_a_radian = float(map.width / (2 * kPi));
    source.minus_sin_lon.assign(source.stride(), 0);
    source.cos_lon.assign(source.stride(), 0);
    for (auto& channel : source.channels) {
      channel.assign(source.stride() * std::size_t(map.height), 0);
    }
    for (int y = 0; y < map.height; ++y) {
      const double lat = kPi * (0.5 - (y + 0.5) / map.height);
      source.rows.push_back({float(std::sin(lat)), float(std::cos(lat)), float(std::cos(lat))});
      for (int x = 0; x < 2 * map.width; ++x) {
        const double lon = 2 * kPi * ((x % map.width + 0.5) / map.width - 0.5);
        source.minus_sin_lon[std::size_t(x)] = float(-std::sin(lon));
        source.cos_lon[std::size_t(x)] = float(std::cos(lon));
        for (int c = 0; c < 3; ++c) {
          source.channels[c][std::size_t(y) * source.stride() + std::size_t(x)] =
              map.at(x % map.width, y)[c];
        }
      }
    }
  }
};

// Texel by texel in double precision.
Eigen::Vector3d Expected(const ImageRgbF& map, double exponent, double cos_cut,
                         const Eigen::Vector3d& d) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weight = 0;
  for (int y = 0; y < map.height; ++y) {
    const double lat = kPi * (0.5 - (y + 0.5) / map.height);
    for (int x = 0; x < map.width; ++x) {
      const double lon = 2 * kPi * ((x + 0.5) / map.width - 0.5);
      const double cosine = d.dot(Eigen::Vector3d(-std::sin(lon) * std::cos(lat), std::sin(lat),
                                                  std::cos(lon) * std::cos(lat)));
      if (cosine < cos_cut) continue;
      const double w = std::cos(lat) * std::pow(cosine, exponent);
      sum += w * Eigen::Map<const Eigen::Vector3f>(map.at(x, y)).cast<double>();
      weight += w;
    }
  }
  return sum / weight;
}

// Across the seam, at the poles and anywhere, on every instruction set.
TEST(LobeMean, IsTheWeightedMeanOfTheTexels) {
  const Light light;
  std::mt19937 random(9);
  std::normal_distribution<double> any;
  std::vector<Eigen::Vector3d> directions = {{0, 1, 0}, {0, -1, 0}, {0, 0, -1}, {0.01, 0.2, -1}};
  for (int i = 0; i < 40; ++i) directions.emplace_back(any(random), any(random), any(random));
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();  // choose anew at the next call
    for (const double exponent : {1.0, 8.0, 60.0}) {
      // A texel at the cut, counted or not, changes the mean by 1e-4 of itself at most.
      const double cos_cut = std::pow(1e-4, 1 / exponent);
      const LobeKernel kernel(exponent, cos_cut);
      for (const Eigen::Vector3d& direction : directions) {
        const Eigen::Vector3d d = direction.normalized();
        const Eigen::Vector3f mean = LobeMean(light.source, kernel, d.cast<float>());
        EXPECT_LT((mean.cast<double>() - Expected(light.map, exponent, cos_cut, d)).norm(), 3e-4)
            << hwy::TargetName(target) << ", " << exponent << ": " << d.transpose();
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

TEST(LobeMean, IsZeroWhereNoTexelLiesWithinItsCut) {
  const Light light;
  const LobeKernel kernel(1e6, 1 - 1e-7);
  // Between texels, which are 10 degrees apart.
  EXPECT_EQ(LobeMean(light.source, kernel, Eigen::Vector3f(0, 0, 1)), Eigen::Vector3f(0, 0, 0));
}

}  // namespace
}  // namespace lorgnette
