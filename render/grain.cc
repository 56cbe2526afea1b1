// SPDX-License-Identifier: Apache-2.0
#include "render/grain.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "render/color.h"

namespace lorgnette {
namespace {

constexpr int kBlock = 16;
constexpr double kSmoothBlocks = 0.2;   // share of the blocks that speak for the grain
constexpr double kPixelBlur_px = 0.29;  // what the renderer's own box filter does: 1 / sqrt(12)
constexpr double kReblur_px = 1;

// Place of a pixel in a picture of that width.
std::size_t At(int x, int y, int width) {
  return std::size_t(y) * std::size_t(width) + std::size_t(x);
}

// Calls work(y) for every row.
template <typename Work>
void ForRows(int height, Work&& work) {
  constexpr int kRowsATask = 32;
  tbb::parallel_for(tbb::blocked_range<int>(0, height, kRowsATask),
                    [&](const tbb::blocked_range<int>& rows) {
                      for (int y = rows.begin(); y < rows.end(); ++y) work(y);
                    });
}

// Display-encoded luma, 0..255.
std::vector<float> CodeLuma(const ImageRgbF& image) {
  std::vector<float> luma(std::size_t(image.width) * std::size_t(image.height));
  ForRows(image.height, [&](int row) {
    const float* p = image.at(0, row);
    float* out = luma.data() + std::size_t(row) * std::size_t(image.width);
    for (int x = 0; x < image.width; ++x, p += 3) {
      const double y = 0.2126 * double(p[0]) + 0.7152 * double(p[1]) + 0.0722 * double(p[2]);
      out[x] = float(255 * SrgbFromLinear(std::clamp(y, 0.0, 1.0)));
    }
  });
  return luma;
}

std::vector<float> GaussianWeights(double sigma) {
  const int reach = std::max(1, int(std::ceil(3 * sigma)));
  std::vector<float> weights;
  float sum = 0;
  for (int k = -reach; k <= reach; ++k) {
    weights.push_back(float(std::exp(-0.5 * k * k / (sigma * sigma))));
    sum += weights.back();
  }
  for (float& w : weights) w /= sum;
  return weights;
}

// Blurs `channels` interleaved values a pixel; borders repeat.
std::vector<float> Blurred(const std::vector<float>& in, int width, int height, int channels,
                           double sigma) {
  const std::vector<float> weights = GaussianWeights(sigma);
  const int reach = int(weights.size()) / 2;
  const float* centre = weights.data() + reach;
  std::vector<float> across(in.size(), 0), out(in.size(), 0);
  ForRows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      for (int k = -reach; k <= reach; ++k) {
        const int from = std::clamp(x + k, 0, width - 1);
        for (int c = 0; c < channels; ++c) {
          across[At(x, y, width) * std::size_t(channels) + std::size_t(c)] +=
              centre[k] * in[At(from, y, width) * std::size_t(channels) + std::size_t(c)];
        }
      }
    }
  });
  ForRows(height, [&](int y) {
    for (int k = -reach; k <= reach; ++k) {
      const int from = std::clamp(y + k, 0, height - 1);
      const float w = centre[k];
      for (int i = 0; i < width * channels; ++i) {
        out[At(i, y, width * channels)] += w * across[At(i, from, width * channels)];
      }
    }
  });
  return out;
}

double MeasureGrain(const std::vector<float>& luma, int width, int height) {
  std::vector<double> blocks;
  for (int by = 1; by + kBlock < height; by += kBlock) {
    for (int bx = 1; bx + kBlock < width; bx += kBlock) {
      double sum = 0;
      int clipped = 0;
      for (int y = by; y < by + kBlock; ++y) {
        for (int x = bx; x < bx + kBlock; ++x) {
          const auto at = [&](int dx, int dy) { return double(luma[At(x + dx, y + dy, width)]); };
          clipped += at(0, 0) < 2 || at(0, 0) > 253;
          sum += std::abs(at(-1, -1) - 2 * at(0, -1) + at(1, -1) - 2 * at(-1, 0) + 4 * at(0, 0) -
                          2 * at(1, 0) + at(-1, 1) - 2 * at(0, 1) + at(1, 1));
        }
      }
      // Clipped light has no grain to show.
      if (clipped > kBlock) continue;
      blocks.push_back(std::sqrt(std::numbers::pi / 2) / (6.0 * kBlock * kBlock) * sum);
    }
  }
  if (blocks.empty()) return 0;
  const auto at = blocks.begin() + std::ptrdiff_t(kSmoothBlocks * double(blocks.size()));
  std::nth_element(blocks.begin(), at, blocks.end());
  return *at;
}

double MeasureBlur(const std::vector<float>& luma, int width, int height) {
  const std::vector<float> again = Blurred(luma, width, height, 1, kReblur_px);
  const auto gradient = [&](const std::vector<float>& v, int x, int y) {
    const auto at = [&](int dx, int dy) { return double(v[At(x + dx, y + dy, width)]); };
    return std::hypot(at(1, 0) - at(-1, 0), at(0, 1) - at(0, -1));
  };
  // The crests of the strongest gradients are edges.
  struct Edge {
    double strength, ratio;
  };
  std::vector<Edge> edges;
  constexpr double kStrong = 30;  // code values over two pixels
  for (int y = 2; y < height - 2; ++y) {
    for (int x = 2; x < width - 2; ++x) {
      const double g = gradient(luma, x, y);
      if (g < kStrong) continue;
      const double gx = double(luma[At(x + 1, y, width)]) - double(luma[At(x - 1, y, width)]);
      const bool horizontal = std::abs(gx) > 0.7 * g;
      const int dx = horizontal ? 1 : 0, dy = horizontal ? 0 : 1;
      if (gradient(luma, x + dx, y + dy) > g || gradient(luma, x - dx, y - dy) > g) continue;
      const double blurred = gradient(again, x, y);
      if (blurred > 0) edges.push_back({g, g / blurred});
    }
  }
  constexpr std::size_t kFewestEdges = 20;
  if (edges.size() < kFewestEdges) return 0;
  // The sharpest edges tell the camera's blur; softer ones are soft in the scene.
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.ratio > b.ratio; });
  const double ratio = edges[edges.size() / 10].ratio;
  if (!(ratio > 1)) return 0;
  // Central differences blur, too: a box of two pixels.
  constexpr double kDifference2 = 4.0 / 12;
  const double total2 = kReblur_px * kReblur_px / (ratio * ratio - 1);
  return std::sqrt(std::max(0.0, total2 - kDifference2));
}

// A hash of a pixel, as a normal deviate (sum of four uniform ones).
float Grain(std::uint32_t seed, std::uint32_t x, std::uint32_t y) {
  std::uint32_t h = seed ^ (x * 0x9E3779B1u) ^ (y * 0x85EBCA77u);
  float sum = 0;
  for (int i = 0; i < 4; ++i) {
    h ^= h >> 16;
    h *= 0x7FEB352Du;
    h ^= h >> 15;
    h *= 0x846CA68Bu;
    h ^= h >> 16;
    sum += float(h >> 8) * (1.0f / (1 << 24)) - 0.5f;
  }
  return sum * 1.7320508f;  // four uniform deviates have variance 4 / 12
}

}  // namespace

CameraLook MeasureCameraLook(const ImageRgbF& input) {
  const std::vector<float> luma = CodeLuma(input);
  return {MeasureGrain(luma, input.width, input.height),
          MeasureBlur(luma, input.width, input.height)};
}

double AddedBlur(const CameraLook& look) {
  return std::sqrt(std::max(0.0, look.blur_px * look.blur_px - kPixelBlur_px * kPixelBlur_px));
}

int CameraLookReach(const CameraLook& look) { return int(std::ceil(3 * AddedBlur(look))) + 1; }

void ApplyCameraLook(const CameraLook& look, const std::vector<float>& coverage, std::uint32_t seed,
                     int origin_x, int origin_y, ImageRgbF& picture) {
  LG_CHECK_EQ(coverage.size() * 3, picture.data.size());
  // Only the box around what was inserted is worked on.
  int x0 = picture.width, y0 = picture.height, x1 = -1, y1 = -1;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (coverage[At(x, y, picture.width)] <= 0) continue;
      x0 = std::min(x0, x);
      x1 = std::max(x1, x);
      y0 = std::min(y0, y);
      y1 = std::max(y1, y);
    }
  }
  if (x1 < 0) return;
  const double sigma = AddedBlur(look);
  const int reach = CameraLookReach(look);
  x0 = std::max(0, x0 - reach);
  y0 = std::max(0, y0 - reach);
  x1 = std::min(picture.width - 1, x1 + reach);
  y1 = std::min(picture.height - 1, y1 + reach);
  const int width = x1 - x0 + 1, height = y1 - y0 + 1;
  const std::size_t pixels = At(0, height, width);
  std::vector<float> colour(pixels * 3), share(pixels);
  for (int y = 0; y < height; ++y) {
    std::copy_n(picture.at(x0, y0 + y), 3 * width, colour.data() + At(0, y, 3 * width));
    std::copy_n(coverage.data() + At(x0, y0 + y, picture.width), width,
                share.data() + At(0, y, width));
  }
  std::vector<float> soft = colour, near = share;
  if (sigma > kLeastBlur_px) {
    soft = Blurred(colour, width, height, 3, sigma);
    near = Blurred(share, width, height, 1, sigma);
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = At(x, y, width);
      if (near[i] <= 0) continue;
      // Full where half of the neighbourhood was inserted or more.
      const float mix = std::min(1.0f, 2 * near[i]);
      const float grain =
          float(look.grain_codes) * std::min(1.0f, share[i]) *
          Grain(seed, std::uint32_t(origin_x + x0 + x), std::uint32_t(origin_y + y0 + y));
      float* out = picture.at(x0 + x, y0 + y);
      for (std::size_t c = 0; c < 3; ++c) {
        const float level = colour[3 * i + c] + mix * (soft[3 * i + c] - colour[3 * i + c]);
        out[c] = level;
        if (grain == 0) continue;
        const double code = 255 * SrgbFromLinear(std::clamp(double(level), 0.0, 1.0));
        const double with = LinearFromSrgb(std::max(0.0, code + double(grain)) / 255);
        if (level <= 1) out[c] = float(with);
      }
    }
  }
}

}  // namespace lorgnette
