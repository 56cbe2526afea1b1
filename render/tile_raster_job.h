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
  float* inverse_z;                              // one a sample: of the nearest so far, or 0
  std::uint32_t* nearest;                        // its triangle, or kNothing
  float *u, *v;  // weights of its second and third vertex, where there is one
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
    // Without a branch: which end comes first is a toss-up.
    const bool ordered = (p.y < q.y) | ((p.y == q.y) & (p.x < q.x));
    x0 = ordered ? p.x : q.x;
    y0 = ordered ? p.y : q.y;
    along_x = q.x - p.x;
    along_y = q.y - p.y;
  }
};

}  // namespace lorgnette::raster
