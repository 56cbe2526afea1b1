// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "render/picture_view.h"

namespace lorgnette {
namespace {

// Columns of 1 and 0 in turns: the finest there is.
ImageRgbF Stripes() {
  ImageRgbF image(64, 32);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) std::fill_n(image.at(x, y), 3, float(x % 2));
  }
  return image;
}

TEST(PictureSampling, AFootprintOfSeveralPixelsSeesTheirMean) {
  const ImageRgbF image = Stripes();
  const InputPicture picture(image);
  for (const float side : {2.0f, 3.0f, 4.0f}) {
    double least = 1, most = 0;
    for (int i = 0; i < 100; ++i) {
      const float x = 20 + 0.07f * float(i);
      const double value = double(SampleMean(picture, x, 16, side).x());
      least = std::min(least, value);
      most = std::max(most, value);
    }
    // A square's mean over stripes of one pixel keeps 1 / (2 side) at most.
    EXPECT_LE(most - least, 1 / double(side) + 0.1) << side;
    EXPECT_NEAR(0.5 * (most + least), 0.5, 0.05) << side;
  }
}

TEST(PictureSampling, AFootprintOfOnePixelIsSharp) {
  const ImageRgbF image = Stripes();
  const InputPicture picture(image);
  for (const float x : {10.5f, 11.2f, 30.9f}) {
    EXPECT_EQ(SampleMean(picture, x, 9.5f, 1), SampleSharp(picture, x, 9.5f));
  }
}

}  // namespace
}  // namespace lorgnette
