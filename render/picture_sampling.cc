// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "render/picture_view.h"

namespace lorgnette {
namespace {

using Texel = Eigen::Map<const Eigen::Vector3f>;

// Catmull-Rom weights of four neighbours, sharpened by [-1 26 -1] / 24: six taps.
void SharpCubicWeights(float f, float w[6]) {
  const float f2 = f * f, f3 = f2 * f;
  const float c[4] = {-0.5f * f3 + f2 - 0.5f * f, 1.5f * f3 - 2.5f * f2 + 1,
                      -1.5f * f3 + 2 * f2 + 0.5f * f, 0.5f * f3 - 0.5f * f2};
  constexpr float kSide = -1.0f / 24, kMiddle = 26.0f / 24;
  w[0] = kSide * c[0];
  w[1] = kMiddle * c[0] + kSide * c[1];
  w[2] = kMiddle * c[1] + kSide * (c[0] + c[2]);
  w[3] = kMiddle * c[2] + kSide * (c[1] + c[3]);
  w[4] = kMiddle * c[3] + kSide * c[2];
  w[5] = kSide * c[3];
}

}  // namespace

Eigen::Vector3f SampleBilinear(const ImageRgbF& image, float x, float y) {
  const float column = std::clamp(x - 0.5f, 0.0f, float(image.width - 1));
  const float row = std::clamp(y - 0.5f, 0.0f, float(image.height - 1));
  const int x0 = int(column), y0 = int(row);
  const int x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
  const float fx = column - float(x0), fy = row - float(y0);
  return (1 - fy) * ((1 - fx) * Texel(image.at(x0, y0)) + fx * Texel(image.at(x1, y0))) +
         fy * ((1 - fx) * Texel(image.at(x0, y1)) + fx * Texel(image.at(x1, y1)));
}

Eigen::Vector3f SampleBicubic(const ImageRgbF& image, float x, float y) {
  const float column = std::clamp(x - 0.5f, 0.0f, float(image.width - 1));
  const float row = std::clamp(y - 0.5f, 0.0f, float(image.height - 1));
  const int x0 = int(column) - 2, y0 = int(row) - 2;
  float wx[6], wy[6];
  SharpCubicWeights(column - float(x0 + 2), wx);
  SharpCubicWeights(row - float(y0 + 2), wy);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  if (x0 >= 0 && y0 >= 0 && x0 + 5 < image.width && y0 + 5 < image.height) {
    for (int j = 0; j < 6; ++j) {
      const float* texel = image.at(x0, y0 + j);
      float r = 0, g = 0, b = 0;
      for (int i = 0; i < 6; ++i, texel += 3) {
        r += wx[i] * texel[0];
        g += wx[i] * texel[1];
        b += wx[i] * texel[2];
      }
      sum += wy[j] * Eigen::Vector3f(r, g, b);
    }
  } else {
    for (int j = 0; j < 6; ++j) {
      for (int i = 0; i < 6; ++i) {
        sum += wx[i] * wy[j] *
               Texel(image.at(std::clamp(x0 + i, 0, image.width - 1),
                              std::clamp(y0 + j, 0, image.height - 1)));
      }
    }
  }
  return sum.cwiseMax(0.0f);
}

// Push and pull (Gortler et al. 1996): means of the known pixels go up a pyramid, and come down
// into the holes.
FilledPicture::FilledPicture(const ImageRgbF& input, const std::vector<std::uint8_t>& known) {
  struct Level {
    ImageRgbF colour;
    std::vector<float> weight;
  };
  std::vector<Level> levels(1);
  Level& base = levels.front();
  base.colour = ImageRgbF(ReducedSide(input.width), ReducedSide(input.height));
  base.weight.assign(known.size(), 0);
  for (int y = 0; y < base.colour.height; ++y) {
    for (int x = 0; x < base.colour.width; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(base.colour.width) + std::size_t(x);
      if (!known[i]) continue;
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      float count = 0;
      for (int v = y * kStep; v < std::min((y + 1) * kStep, input.height); ++v) {
        for (int u = x * kStep; u < std::min((x + 1) * kStep, input.width); ++u, ++count) {
          sum += Texel(input.at(u, v));
        }
      }
      sum /= count;
      std::copy(sum.data(), sum.data() + 3, base.colour.at(x, y));
      base.weight[i] = 1;
    }
  }
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
  return SampleBilinear(filled_, x / float(kStep), y / float(kStep));
}

}  // namespace lorgnette
