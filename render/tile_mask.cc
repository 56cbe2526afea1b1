// SPDX-License-Identifier: Apache-2.0
#include "render/tile_mask.h"

#include <algorithm>

namespace lorgnette {

PixelBox TileMask::Area(std::size_t tile, int width, int height) const {
  const int x0 = int(tile) % columns * kTileSide, y0 = int(tile) / columns * kTileSide;
  return {x0, y0, std::min(x0 + kTileSide, width), std::min(y0 + kTileSide, height)};
}

PixelBox TileMask::Bounds() const {
  PixelBox box{columns * kTileSide, rows * kTileSide, 0, 0};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (content[std::size_t(row) * std::size_t(columns) + std::size_t(column)] == 0) continue;
      box = {std::min(box.x0, column * kTileSide), std::min(box.y0, row * kTileSide),
             std::max(box.x1, (column + 1) * kTileSide), std::max(box.y1, (row + 1) * kTileSide)};
    }
  }
  return box.empty() ? PixelBox{} : box;
}

}  // namespace lorgnette
