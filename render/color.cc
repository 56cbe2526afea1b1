// SPDX-License-Identifier: Apache-2.0
#include "render/color.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace lorgnette {
namespace {

// A bucket holds the floats that share sign, exponent and the leading 8 bits of the mantissa. In
// [0, 1] a bucket spans at most 1/256 of an e-fold, less than half a code, so that finding the code
// needs one comparison from the code at the bucket's lower end.
constexpr int kBucketShift = 15;
constexpr std::uint32_t kBuckets = (std::bit_cast<std::uint32_t>(1.0f) >> kBucketShift) + 1;

struct Tables {
  std::array<float, 256> linear{};
  // linear value from which on the code is i + 1; the last one is never reached
  std::array<float, 256> next{};
  std::array<std::uint8_t, kBuckets> first_code{};

  Tables() {
    for (int i = 0; i < 256; ++i) {
      linear[i] = static_cast<float>(LinearFromSrgb(i / 255.0));
      const double border = LinearFromSrgb((i + 0.5) / 255.0);
      float next_up = static_cast<float>(border);
      if (next_up < border) {
        next_up = std::nextafter(next_up, std::numeric_limits<float>::infinity());
      }
      next[i] = i < 255 ? next_up : std::numeric_limits<float>::infinity();
    }
    int code = 0;
    for (std::uint32_t bucket = 0; bucket < kBuckets; ++bucket) {
      const float lower = std::bit_cast<float>(bucket << kBucketShift);
      while (lower >= next[code]) ++code;
      first_code[bucket] = static_cast<std::uint8_t>(code);
    }
  }
};

const Tables& GetTables() {
  static const Tables tables;
  return tables;
}

std::uint8_t Code(const Tables& tables, float linear) {
  constexpr float kBelowOne = 0x1.fffffep-1f;                        // its code is 255
  const float within = std::min(std::max(0.0f, linear), kBelowOne);  // NaN: 0
  const std::uint8_t code = tables.first_code[std::bit_cast<std::uint32_t>(within) >> kBucketShift];
  return static_cast<std::uint8_t>(code + (within >= tables.next[code]));
}

constexpr std::size_t kGrain = 1 << 15;  // values a task

}  // namespace

double LinearFromSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double SrgbFromLinear(double linear) {
  // 0.04045 / 12.92: the border of LinearFromSrgb, so that the two are inverse to each other.
  return linear <= 0.04045 / 12.92 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

float LinearFromCode(std::uint8_t code) { return GetTables().linear[code]; }

void LinearFromCodes(const std::uint8_t* codes, std::size_t count, float* linear) {
  const Tables& tables = GetTables();
  for (std::size_t i = 0; i < count; ++i) linear[i] = tables.linear[codes[i]];
}

std::uint8_t CodeFromLinear(float linear) { return Code(GetTables(), linear); }

void CodesFromLinear(const float* linear, std::size_t count, std::uint8_t* codes) {
  const Tables& tables = GetTables();
  for (std::size_t i = 0; i < count; ++i) codes[i] = Code(tables, linear[i]);
}

ImageRgbF LinearFromDisplay(const ImageRgb8& image) {
  const Tables& tables = GetTables();
  ImageRgbF result(image.width, image.height);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, image.data.size(), kGrain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        result.data[i] = tables.linear[image.data[i]];
                      }
                    });
  return result;
}

ImageRgb8 DisplayFromLinear(const ImageRgbF& image) {
  const Tables& tables = GetTables();
  ImageRgb8 result(image.width, image.height);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, image.data.size(), kGrain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        result.data[i] = Code(tables, image.data[i]);
                      }
                    });
  return result;
}

}  // namespace lorgnette
