// SPDX-License-Identifier: Apache-2.0
// The tiles of a picture that can change. Internal to render/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/input_picture.h"

namespace lorgnette {

inline constexpr int kTileSide = 16;  // pixels
// Of a pixel of a tile, from the tile's own corner.
inline std::size_t TileIndex(int x, int y) {
  return std::size_t(y) * std::size_t(kTileSide) + std::size_t(x);
}

// One of each pixel of a tile.
using PixelFlags = std::array<bool, std::size_t(kTileSide) * kTileSide>;

enum TileContent : std::uint8_t {
  kTileShadow = 1,  // face that the frame can darken
  kTileFrame = 2,
  kTileRightLens = 4,
  kTileLeftLens = 8,
};

struct TileMask {
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> content;  // TileContent bits; 0: the tile stays as it is
  // The pixels of a tile, inside a picture of this size.
  PixelBox Area(std::size_t tile, int width, int height) const;
  // Box around the marked tiles, in pixels (it may reach past the picture); empty if none is.
  PixelBox Bounds() const;
};

}  // namespace lorgnette
