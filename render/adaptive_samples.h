// SPDX-License-Identifier: Apache-2.0
// Where the rays of a tile go: side x side a pixel, or one and more only where it pays.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "render/tile_mask.h"
#include "render/tile_renderer.h"

namespace lorgnette {

// Samples of the pixels that `wanted` names (of all: null), side x side a pixel, in blocks of
// pixels that fill a packet of 16.
void PlaceSamples(const PixelBox& area, int side, const PixelFlags* wanted,
                  std::vector<CameraSample>& samples);

// Adaptive: what the ray through a pixel's centre met.
struct Glance {
  CameraSample::Kind kind = CameraSample::Kind::kBackground;
  std::uint8_t code = 0;  // of a frame its light, encoded; of head and background their factor
  bool edge = false;      // left out so far (TileRenderer::Trace): no code
  bool turns = false;     // CameraSample::turns
  static Glance At(const CameraSample& sample, bool is_edge);
  // Of head or background.
  static Glance AtInput(CameraSample::Kind kind, const Eigen::Vector3f& factor);
};

// Pixels beside which (left, right, above, below) something else is met, unless both show the input
// about as much darkened; and those of the frame with some contrast. What differs at a corner alone
// is a small part of the pixel: with corners a fourth more pixels were refined, for 0.2 to 0.6 dB.
//   glances  of the pixels of `box`, row by row; beyond it they are taken to go on as at its border
PixelFlags PixelsToRefine(const PixelBox& area, const PixelBox& box,
                          const std::vector<Glance>& glances);

// Adaptive, where only the face's shadow falls: samples lie on every second column and row of the
// tile and on its last ones.
bool OnShadowGrid(int x, int y);

// The pixels between those of the grid take the mean of their neighbours on it, where these met the
// same thing and their factors differ by less than a code value or two; `wanted` receives the
// others. `factor` and `kind` hold a tile's pixels.
void FillShadowGrid(const PixelBox& area, std::vector<Eigen::Vector3f>& factor,
                    const std::vector<CameraSample::Kind>& kind, PixelFlags& wanted);

}  // namespace lorgnette
