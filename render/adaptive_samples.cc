// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive_samples.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace lorgnette {
namespace {

// Pixels of the frame that differ from a neighbour by more than this many code values take all
// their samples.
constexpr int kFrameContrast = 6;
// Of the shadow's factor between neighbours on the grid: a code value or two.
constexpr float kShadowContrast = 0.02f;

}  // namespace

void PlaceSamples(const PixelBox& area, int side, const std::vector<bool>& wanted,
                  std::vector<CameraSample>& samples) {
  samples.clear();
  const int block = std::max(1, 4 / side);
  for (int by = area.y0; by < area.y1; by += block) {
    for (int bx = area.x0; bx < area.x1; bx += block) {
      for (int y = by; y < std::min(by + block, area.y1); ++y) {
        for (int x = bx; x < std::min(bx + block, area.x1); ++x) {
          const int pixel = (y - area.y0) * kTileSide + (x - area.x0);
          if (!wanted.empty() && !wanted[std::size_t(pixel)]) continue;
          for (int s = 0; s < side * side; ++s) {
            CameraSample sample;
            sample.x = float(x) + (float(s % side) + 0.5f) / float(side);
            const int row = s / side;
            sample.y = float(y) + (float(row) + 0.5f) / float(side);
            sample.pixel = std::uint16_t(pixel);
            samples.push_back(sample);
          }
        }
      }
    }
  }
}

std::vector<bool> PixelsToRefine(const PixelBox& area, const PixelBox& box,
                                 const std::vector<Glance>& glances) {
  using Kind = CameraSample::Kind;
  std::vector<bool> wanted(std::size_t(kTileSide) * kTileSide, false);
  const auto at = [&](int x, int y) {
    const std::size_t row = std::size_t(std::clamp(y, box.y0, box.y1 - 1) - box.y0);
    const std::size_t column = std::size_t(std::clamp(x, box.x0, box.x1 - 1) - box.x0);
    return glances[row * std::size_t(box.x1 - box.x0) + column];
  };
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      const Glance own = at(x, y);
      bool refine = own.kind == Kind::kLensElsewhere;
      for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
        const Glance other = at(x + dx, y + dy);
        refine = refine || other.kind != own.kind ||
                 (own.kind == Kind::kFrame &&
                  std::abs(int(own.code) - int(other.code)) > kFrameContrast);
      }
      wanted[TileIndex(x - area.x0, y - area.y0)] = refine;
    }
  }
  return wanted;
}

bool OnShadowGrid(int x, int y) {
  const auto on = [](int v) { return v % 2 == 0 || v == kTileSide - 1; };
  return on(x) && on(y);
}

void FillShadowGrid(const PixelBox& area, std::vector<Eigen::Vector3f>& factor,
                    const std::vector<CameraSample::Kind>& kind, std::vector<bool>& wanted) {
  wanted.assign(std::size_t(kTileSide) * kTileSide, false);
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
