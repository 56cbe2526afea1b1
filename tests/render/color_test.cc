// SPDX-License-Identifier: Apache-2.0
#include "render/color.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace lorgnette {
namespace {

TEST(Color, All256CodesSurviveTheRoundTrip) {
  ImageRgb8 image(256, 1);
  for (int i = 0; i < 256; ++i) {
    image.at(i, 0)[0] = static_cast<std::uint8_t>(i);
    image.at(i, 0)[1] = static_cast<std::uint8_t>(255 - i);
    image.at(i, 0)[2] = static_cast<std::uint8_t>((i * 7) & 255);
  }
  EXPECT_EQ(DisplayFromLinear(LinearFromDisplay(image)).data, image.data);
}

TEST(Color, TransferFunctionsAreInverseToEachOther) {
  // Two evaluations of pow, each within an ulp, and the slope of at most 12.92 between them.
  constexpr double kBound = 20 * std::numeric_limits<double>::epsilon();
  for (int i = 0; i <= 10000; ++i) {
    const double x = i / 10000.0;
    EXPECT_NEAR(SrgbFromLinear(LinearFromSrgb(x)), x, kBound) << x;
  }
}

TEST(Color, TransferHasTheValuesOfTheStandard) {
  EXPECT_EQ(LinearFromSrgb(0.0), 0);
  EXPECT_EQ(LinearFromSrgb(1.0), 1);
  // IEC 61966-2-1: code 10 lies on the linear part; mid grey 128 is 21.586 per cent.
  EXPECT_EQ(LinearFromCode(10), static_cast<float>(10 / 255.0 / 12.92));
  EXPECT_NEAR(LinearFromCode(128), 0.215861, 5e-7);  // half a unit of the printed digits
}

TEST(Color, CodeIsTheNearestOnTheEncodedScale) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> log_value(std::log(1e-7), std::log(1.5));
  for (int i = 0; i < 200000; ++i) {
    const float linear = static_cast<float>(std::exp(log_value(random)));
    const double encoded = 255 * SrgbFromLinear(std::min(1.0, static_cast<double>(linear)));
    // Exactly half-way values are the only ones where two codes are equally near.
    EXPECT_LE(std::abs(CodeFromLinear(linear) - encoded), 0.5 + 1e-9) << linear;
  }
}

TEST(Color, CodeIsMonotonicAcrossEveryBucketBorder) {
  int last = 0;
  for (float x = 1e-6f; x < 1.1f; x *= 1.0005f) {
    const int code = CodeFromLinear(x);
    EXPECT_GE(code, last);
    last = code;
  }
  EXPECT_EQ(last, 255);
}

TEST(Color, ValuesOutsideTheRangeAreClamped) {
  EXPECT_EQ(CodeFromLinear(-1), 0);
  EXPECT_EQ(CodeFromLinear(-0.0f), 0);
  EXPECT_EQ(CodeFromLinear(1), 255);
  EXPECT_EQ(CodeFromLinear(40), 255);
  EXPECT_EQ(CodeFromLinear(std::numeric_limits<float>::infinity()), 255);
  EXPECT_EQ(CodeFromLinear(std::numeric_limits<float>::quiet_NaN()), 0);
  EXPECT_EQ(CodeFromLinear(std::numeric_limits<float>::denorm_min()), 0);
}

}  // namespace
}  // namespace lorgnette
