// SPDX-License-Identifier: Apache-2.0
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/picture_view.h"

namespace lorgnette {
namespace {

using Texel = Eigen::Map<const Eigen::Vector3f>;

constexpr int kTaps = 8;

// Weights of eight neighbours of a position `f` past the fourth of them: Keys' six-point cubic
// (fourth-order convergence; IEEE Trans. ASSP 29(6), 1981), over samples that two terms of the
// inverse of a box mean have sharpened: 1 - d^2 / 24 + 3 d^4 / 640, d^2 the second difference.
void ComputeWeights(float f, float w[kTaps]) {
  const auto keys = [](float x) {
    x = std::abs(x);
    if (x < 1) return ((4.0f / 3) * x - 7.0f / 3) * x * x + 1;
    if (x < 2) return ((-7.0f / 12) * x + 3) * x * x - (59.0f / 12) * x + 2.5f;
    if (x < 3) return ((1.0f / 12) * x - 2.0f / 3) * x * x + 1.75f * x - 1.5f;
    return 0.0f;
  };
  float c[kTaps + 4];
  for (int k = 0; k < kTaps + 4; ++k) c[k] = keys(float(k - 5) - f);
  constexpr float kFourth = 3.0f / 640, kSecond = -1.0f / 24;
  constexpr float kFar = kFourth, kSide = kSecond - 4 * kFourth,
                  kMiddle = 1 - 2 * kSecond + 6 * kFourth;
  float sum = 0;
  for (int k = 0; k < kTaps; ++k) {
    w[k] = kFar * (c[k] + c[k + 4]) + kSide * (c[k + 1] + c[k + 3]) + kMiddle * c[k + 2];
    sum += w[k];
  }
  for (int k = 0; k < kTaps; ++k) w[k] /= sum;
}

// The weights at steps of 1/1024 pixel: at most 1/2048 pixel from where they were asked for.
class WeightTable {
 public:
  WeightTable() {
    for (int i = 0; i <= kSteps; ++i) ComputeWeights(float(i) / kSteps, weights_[i]);
  }
  const float* At(float f) const { return weights_[int(f * kSteps + kHalf)]; }  // the nearest

 private:
  static constexpr int kSteps = 1024;
  static constexpr float kHalf = 0.5f;
  float weights_[kSteps + 1][kTaps];
};

constexpr int kMostTaps = 6;

// n positions over a side about `x`, bilinear: the pixels that they read, ascending, and their
// weights. Both axes together are n x n bilinear taps.
struct AxisTaps {
  int count = 0;
  int at[2 * kMostTaps];
  float weight[2 * kMostTaps];
  AxisTaps(float x, float side_px, int n, int size) {
    for (int i = 0; i < n; ++i) {
      const float position = std::clamp(x + side_px * ((float(i) + 0.5f) / float(n) - 0.5f) - 0.5f,
                                        0.0f, float(size - 1));
      const int first = int(position);
      const float share = position - float(first);
      Add(first, 1 - share);
      Add(std::min(first + 1, size - 1), share);
    }
  }
  void Add(int pixel, float w) {
    // Positions ascend: a pixel that was read before is the last or the last but one.
    for (int k = count - 1; k >= std::max(0, count - 2); --k) {
      if (at[k] != pixel) continue;
      weight[k] += w;
      return;
    }
    at[count] = pixel;
    weight[count++] = w;
  }
};

}  // namespace

Eigen::Vector3f SampleBilinear(const InputPicture& image, float x, float y) {
  const float column = std::clamp(x - 0.5f, 0.0f, float(image.width() - 1));
  const float row = std::clamp(y - 0.5f, 0.0f, float(image.height() - 1));
  const int x0 = int(column), y0 = int(row);
  const int x1 = std::min(x0 + 1, image.width() - 1), y1 = std::min(y0 + 1, image.height() - 1);
  const float fx = column - float(x0), fy = row - float(y0);
  return (1 - fy) * ((1 - fx) * image.Pixel(x0, y0) + fx * image.Pixel(x1, y0)) +
         fy * ((1 - fx) * image.Pixel(x0, y1) + fx * image.Pixel(x1, y1));
}

Eigen::Vector3f SampleSharp(const InputPicture& image, float x, float y) {
  const float column = std::clamp(x - 0.5f, 0.0f, float(image.width() - 1));
  const float row = std::clamp(y - 0.5f, 0.0f, float(image.height() - 1));
  const int x0 = int(column) - 3, y0 = int(row) - 3;
  static const WeightTable table;
  const float* wx = table.At(column - float(x0 + 3));
  const float* wy = table.At(row - float(y0 + 3));
  // Eight rows together, as 24 values side by side; then across.
  if (image.IsReady(x0, y0, x0 + kTaps, y0 + kTaps)) {
    constexpr int kValues = 3 * kTaps;
    alignas(64) float line[kValues];
    const float* from = image.Ready(x0, y0);
    for (int i = 0; i < kValues; ++i) line[i] = wy[0] * from[i];
    for (int j = 1; j < kTaps; ++j) {
      from += image.stride();
      for (int i = 0; i < kValues; ++i) line[i] += wy[j] * from[i];
    }
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (int i = 0; i < kTaps; ++i) sum += wx[i] * Texel(line + 3 * i);
    return sum.cwiseMax(0.0f);
  }
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int j = 0; j < kTaps; ++j) {
    for (int i = 0; i < kTaps; ++i) {
      sum += wx[i] * wy[j] *
             image.Pixel(std::clamp(x0 + i, 0, image.width() - 1),
                         std::clamp(y0 + j, 0, image.height() - 1));
    }
  }
  return sum.cwiseMax(0.0f);
}

Eigen::Vector3f SampleMean(const InputPicture& image, float x, float y, float side_px) {
  constexpr float kSharpUpTo_px = 1.25f;
  if (!(side_px > kSharpUpTo_px)) return SampleSharp(image, x, y);
  const int n = std::min(kMostTaps, int(std::ceil(side_px)));
  const AxisTaps across(x, side_px, n, image.width()), down(y, side_px, n, image.height());
  // With one pixel more to the right, four values can be read at a time.
  if (image.IsReady(across.at[0], down.at[0], across.at[across.count - 1] + 2,
                    down.at[down.count - 1] + 1)) {
    using FourValues = Eigen::Map<const Eigen::Vector4f>;
    Eigen::Vector4f sum = Eigen::Vector4f::Zero();
    for (int j = 0; j < down.count; ++j) {
      Eigen::Vector4f row = Eigen::Vector4f::Zero();
      for (int i = 0; i < across.count; ++i) {
        row += across.weight[i] * FourValues(image.Ready(across.at[i], down.at[j]));
      }
      sum += down.weight[j] * row;
    }
    return sum.head<3>() / float(n * n);
  }
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int j = 0; j < down.count; ++j) {
    Eigen::Vector3f row = Eigen::Vector3f::Zero();
    for (int i = 0; i < across.count; ++i) {
      row += across.weight[i] * image.Pixel(across.at[i], down.at[j]);
    }
    sum += down.weight[j] * row;
  }
  return sum / float(n * n);
}

int FilledPicture::StepOf(int height) {
  constexpr unsigned kRows = 45;
  return int(std::clamp(std::bit_floor(unsigned(height) / kRows), 8u, 64u));
}

// Push and pull (Gortler et al. 1996): means of the known pixels go up a pyramid, and come down
// into the holes.
FilledPicture::FilledPicture(const InputPicture& input, const std::vector<std::uint8_t>& known)
    : step_(StepOf(input.height())) {
  struct Level {
    ImageRgbF colour;
    std::vector<float> weight;
  };
  std::vector<Level> levels(1);
  Level& base = levels.front();
  base.colour = ImageRgbF(ReducedSide(input.width(), step_), ReducedSide(input.height(), step_));
  const int stride = step_ / 2;  // what is made up here needs no more
  base.weight.assign(known.size(), 0);
  tbb::parallel_for(0, base.colour.height, [&](int y) {
    for (int x = 0; x < base.colour.width; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(base.colour.width) + std::size_t(x);
      if (!known[i]) continue;
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      float count = 0;
      for (int v = y * step_; v < std::min((y + 1) * step_, input.height()); v += stride) {
        for (int u = x * step_; u < std::min((x + 1) * step_, input.width()); u += stride) {
          sum += input.Pixel(u, v);
          ++count;
        }
      }
      sum /= count;
      std::copy(sum.data(), sum.data() + 3, base.colour.at(x, y));
      base.weight[i] = 1;
    }
  });
  while (levels.back().colour.width > 1 || levels.back().colour.height > 1) {
    const Level& fine = levels.back();
    Level coarse;
    coarse.colour = ImageRgbF((fine.colour.width + 1) / 2, (fine.colour.height + 1) / 2);
    coarse.weight.assign(coarse.colour.data.size() / 3, 0);
    for (int y = 0; y < fine.colour.height; ++y) {
      for (int x = 0; x < fine.colour.width; ++x) {
        const float w =
            fine.weight[std::size_t(y) * std::size_t(fine.colour.width) + std::size_t(x)];
        float* to = coarse.colour.at(x / 2, y / 2);
        for (int c = 0; c < 3; ++c) to[c] += w * fine.colour.at(x, y)[c];
        coarse.weight[std::size_t(y / 2) * std::size_t(coarse.colour.width) + std::size_t(x / 2)] +=
            w;
      }
    }
    for (std::size_t i = 0; i < coarse.weight.size(); ++i) {
      if (coarse.weight[i] <= 0) continue;
      for (std::size_t c = 0; c < 3; ++c) coarse.colour.data[3 * i + c] /= coarse.weight[i];
      coarse.weight[i] = std::min(coarse.weight[i], 1.0f);
    }
    levels.push_back(std::move(coarse));
  }
  for (std::size_t l = levels.size() - 1; l-- > 0;) {
    Level& fine = levels[l];
    const ImageRgbF& coarse = levels[l + 1].colour;
    for (int y = 0; y < fine.colour.height; ++y) {
      for (int x = 0; x < fine.colour.width; ++x) {
        const float w =
            fine.weight[std::size_t(y) * std::size_t(fine.colour.width) + std::size_t(x)];
        if (w >= 1) continue;
        const Eigen::Vector3f up =
            SampleBilinear(coarse, 0.5f * (float(x) + 0.5f), 0.5f * (float(y) + 0.5f));
        float* to = fine.colour.at(x, y);
        for (int c = 0; c < 3; ++c) to[c] = w * to[c] + (1 - w) * up[c];
      }
    }
  }
  filled_ = std::move(levels.front().colour);
}

Eigen::Vector3f FilledPicture::Sample(float x, float y) const {
  return SampleBilinear(filled_, x / float(step_), y / float(step_));
}

}  // namespace lorgnette
