// SPDX-License-Identifier: Apache-2.0
// What the dispatched code of the rasteriser is called with. Internal to render/tile_raster.cc.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "render/screen_scene.h"

namespace lorgnette::raster {

inline constexpr std::size_t kPacket = 16;              // samples
inline constexpr std::uint32_t kNothing = 0xffffffffu;  // for a triangle

struct Job {
  const ScreenPoint* points;
  const Eigen::Vector3i* triangles;
  const std::uint32_t* list;  // triangles of the tile
  std::size_t list_size;
  float corner_x, corner_y;  // of the tile; what follows is relative to it
  std::size_t packets;
  const float *x, *y;                            // of samples
  const float *low_x, *low_y, *high_x, *high_y;  // boxes, a packet each, filled up to 16
  float* inverse_z;                              // one a sample: the nearest so far
  std::uint32_t* nearest;                        // ... and its triangle
};

// A vertex relative to the tile's corner.
inline ScreenPoint FromCorner(const ScreenPoint& p, float corner_x, float corner_y) {
  return {p.x - corner_x, p.y - corner_y, p.inverse_z};
}

// One side p -> q of a triangle as along_x * (y - y0) - along_y * (x - x0): twice the area of p, q
// and (x, y). Both triangles beside it start from the same end, so that their values are the
// same but for the sign, and no position lies outside both.
struct Side {
  float x0, y0, along_x, along_y;
  Side(const ScreenPoint& p, const ScreenPoint& q) {
    const bool ordered = p.y < q.y || (p.y == q.y && p.x < q.x);
    const ScreenPoint& from = ordered ? p : q;
    const ScreenPoint& to = ordered ? q : p;
    const float sign = ordered ? 1.0f : -1.0f;
    x0 = from.x;
    y0 = from.y;
    along_x = sign * (to.x - from.x);
    along_y = sign * (to.y - from.y);
  }
};

}  // namespace lorgnette::raster
