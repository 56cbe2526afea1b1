// SPDX-License-Identifier: Apache-2.0
#include "render/grain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "render/color.h"

namespace lorgnette {
namespace {

// Bars with edges of a Gaussian's width and grain, display-encoded.
ImageRgbF Bars(double blur_px, double grain_codes) {
  ImageRgbF image(240, 160);
  std::mt19937 random(8);
  std::normal_distribution<double> grain;  // of one code
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double to_edge = (x % 60 < 30 ? 1 : -1) * (15 - std::abs(x % 30 - 14.5));
      const double code =
          127 + 70 * std::erf(to_edge / (std::sqrt(2.0) * blur_px)) + grain_codes * grain(random);
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(LinearFromSrgb(code / 255));
    }
  }
  return image;
}

TEST(CameraLook, MeasuresTheGrainThatIsThere) {
  for (const double grain : {0.0, 2.0, 5.0}) {
    // Blocks of 256 pixels know their standard deviation to some 5 per cent; the smoothest fifth is
    // picked, which is biased low.
    EXPECT_NEAR(MeasureCameraLook(Bars(1.2, grain)).grain_codes, grain, 0.15 * grain + 0.15);
  }
}

TEST(CameraLook, MeasuresTheBlurOfEdges) {
  for (const double blur : {0.8, 1.2, 2.0}) {
    // Below one pixel an edge is sampled too coarsely for more than a quarter.
    const double share = blur < 1 ? 0.3 : 0.15;
    EXPECT_NEAR(MeasureCameraLook(Bars(blur, 0)).blur_px, blur, share * blur) << blur;
  }
}

TEST(CameraLook, GivesInsertedPixelsTheSameGrainEachTimeAndLeavesTheRestAlone) {
  ImageRgbF picture(80, 60);
  std::fill(picture.data.begin(), picture.data.end(), 0.2f);
  std::vector<float> coverage(80 * 60, 0);
  for (int y = 20; y < 50; ++y) {
    for (int x = 10; x < 40; ++x) {
      coverage[std::size_t(y * 80 + x)] = 1;
      for (int c = 0; c < 3; ++c) picture.at(x, y)[c] = 0.1f;
    }
  }
  const CameraLook look{4, 1};
  ImageRgbF once = picture, again = picture;
  ApplyCameraLook(look, coverage, 7, 0, 0, once);
  ApplyCameraLook(look, coverage, 7, 0, 0, again);
  EXPECT_EQ(once.data, again.data);
  double sum = 0, squares = 0;
  int count = 0;
  for (int y = 26; y < 44; ++y) {
    for (int x = 16; x < 34; ++x, ++count) {
      const double code = 255 * SrgbFromLinear(double(once.at(x, y)[0]));
      sum += code;
      squares += code * code;
    }
  }
  // 324 pixels know a standard deviation to 4 per cent.
  EXPECT_NEAR(std::sqrt(squares / count - sum * sum / count / count), 4, 0.5);
  // The edge has become soft, and nothing changes farther than three blurs away.
  EXPECT_GT(once.at(9, 35)[0], 0.1f);
  EXPECT_LT(once.at(9, 35)[0], 0.2f);
  for (int y = 0; y < 60; ++y) EXPECT_EQ(once.at(60, y)[0], picture.at(60, y)[0]);
}

}  // namespace
}  // namespace lorgnette
