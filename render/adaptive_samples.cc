// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive_samples.h"

#include <algorithm>
#include <cstdlib>

#include "render/color.h"

namespace lorgnette {
namespace {

// Pixels of the frame that differ from a neighbour by more than this many code values take all
// their samples.
constexpr int kFrameContrast = 16;
// Of the shadow's factor between neighbours on the grid: a code value or two.
constexpr float kShadowContrast = 0.02f;
// The same between head and background, of 255.
constexpr int kFactorContrast = int(255 * kShadowContrast);

}  // namespace

void PlaceSamples(const PixelBox& area, int side, const PixelFlags* wanted,
                  std::vector<CameraSample>& samples) {
  const std::size_t pixels = wanted != nullptr
                                 ? std::size_t(std::count(wanted->begin(), wanted->end(), true))
                                 : std::size_t(area.x1 - area.x0) * std::size_t(area.y1 - area.y0);
  samples.resize(pixels * std::size_t(side) * std::size_t(side));
  CameraSample* next = samples.data();
  const int block = std::max(1, 4 / side);
  const float step = 1 / float(side);
  for (int by = area.y0; by < area.y1; by += block) {
    for (int bx = area.x0; bx < area.x1; bx += block) {
      for (int y = by; y < std::min(by + block, area.y1); ++y) {
        for (int x = bx; x < std::min(bx + block, area.x1); ++x) {
          const std::size_t pixel = TileIndex(x - area.x0, y - area.y0);
          if (wanted != nullptr && !(*wanted)[pixel]) continue;
          for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
              CameraSample& sample = *next++;
              sample = CameraSample{};
              sample.x = float(x) + (float(column) + 0.5f) * step;
              sample.y = float(y) + (float(row) + 0.5f) * step;
              sample.pixel = std::uint16_t(pixel);
            }
          }
        }
      }
    }
  }
}

Glance Glance::AtInput(CameraSample::Kind kind, const Eigen::Vector3f& factor) {
  return {kind, std::uint8_t(255 * std::clamp(factor.mean(), 0.0f, 1.0f))};
}

Glance Glance::At(const CameraSample& sample, bool is_edge) {
  const SampleClass its = ClassOf(sample.kind);
  if (its == SampleClass::kInput && !is_edge) return AtInput(sample.kind, sample.direct);
  const bool has_code = its == SampleClass::kFrame && !is_edge;
  return {sample.kind, has_code ? CodeFromLinear(sample.inserted.mean()) : std::uint8_t{0}, is_edge,
          sample.turns};
}

PixelFlags PixelsToRefine(const PixelBox& area, const PixelBox& box,
                          const std::vector<Glance>& glances) {
  using Kind = CameraSample::Kind;
  const std::size_t width = std::size_t(box.x1 - box.x0);
  const auto differ = [](const Glance& own, const Glance& other) {
    const SampleClass its = ClassOf(own.kind);
    if (its != ClassOf(other.kind)) return true;
    if (other.edge && its != SampleClass::kGlass) return own.turns;
    const int apart = std::abs(int(own.code) - int(other.code));
    switch (its) {
      case SampleClass::kInput:
        return own.kind != other.kind && apart > kFactorContrast;
      case SampleClass::kFrame:
        return apart > kFrameContrast;
      default:
        return own.kind != other.kind;
    }
  };
  PixelFlags wanted{};
  for (int y = area.y0; y < area.y1; ++y) {
    const Glance* const row = glances.data() + std::size_t(y - box.y0) * width;
    const std::size_t above = y > box.y0 ? width : 0, below = y + 1 < box.y1 ? width : 0;
    for (int x = area.x0; x < area.x1; ++x) {
      const Glance* const own = row + (x - box.x0);
      const std::size_t left = x > box.x0, right = x + 1 < box.x1;
      wanted[TileIndex(x - area.x0, y - area.y0)] =
          own->edge || own->kind == Kind::kLensElsewhere || differ(*own, *(own - left)) ||
          differ(*own, own[right]) || differ(*own, *(own - above)) || differ(*own, own[below]);
    }
  }
  return wanted;
}

bool OnShadowGrid(int x, int y) {
  const auto on = [](int v) { return v % 2 == 0 || v == kTileSide - 1; };
  return on(x) && on(y);
}

void FillShadowGrid(const PixelBox& area, std::vector<Eigen::Vector3f>& factor,
                    const std::vector<CameraSample::Kind>& kind, PixelFlags& wanted) {
  wanted.fill(false);
  const int width = area.x1 - area.x0, height = area.y1 - area.y0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (OnShadowGrid(x, y)) continue;
      const std::size_t own = TileIndex(x, y);
      const int dx = x % 2 != 0 && x != kTileSide - 1 ? 1 : 0;
      const int dy = y % 2 != 0 && y != kTileSide - 1 ? 1 : 0;
      if (x + dx >= width || y + dy >= height) {
        wanted[own] = true;
        continue;
      }
      const std::size_t corners[4] = {TileIndex(x - dx, y - dy), TileIndex(x + dx, y - dy),
                                      TileIndex(x - dx, y + dy), TileIndex(x + dx, y + dy)};
      Eigen::Vector3f low = factor[corners[0]], high = low, sum = Eigen::Vector3f::Zero();
      bool alike = true;
      for (const std::size_t c : corners) {
        low = low.cwiseMin(factor[c]);
        high = high.cwiseMax(factor[c]);
        sum += factor[c];
        alike = alike && kind[c] == kind[corners[0]];
      }
      wanted[own] = !alike || (high - low).maxCoeff() > kShadowContrast;
      factor[own] = 0.25f * sum;
    }
  }
}

}  // namespace lorgnette
