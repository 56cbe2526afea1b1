// SPDX-License-Identifier: Apache-2.0
// Blur and grain of a video, measured on a picture of it and given to what was inserted.
//
// Grain: standard deviation of the display-encoded luma in the smoothest blocks (the operator of
// Immerkaer, CVIU 64(2), 1996). Blur: standard deviation of a Gaussian edge, from the ratio of the
// gradients before and after a known blur (Zhuo and Sim, Pattern Recognition 44(9), 2011). Tested
// on pictures with grain and blur put in.
#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"

namespace lorgnette {

struct CameraLook {
  double grain_codes = 0;  // of 255
  double blur_px = 0;      // standard deviation
};
CameraLook MeasureCameraLook(const ImageRgbF& input);
// Standard deviation of the blur that the renderer's own pictures lack, pixels.
double AddedBlur(const CameraLook& look);
// Less than this is not added.
inline constexpr double kLeastBlur_px = 0.2;

// Softens the picture where `coverage` (one a pixel, 0..1: share of inserted surface that did not
// come through the camera) rises or falls, and lays grain over it. The same seed gives the same
// grain; pixels farther than three blurs from any coverage stay as they are, bit for bit.
//   picture  a part of the picture, whose first pixel is the whole one's (x0, y0)
void ApplyCameraLook(const CameraLook& look, const std::vector<float>& coverage, std::uint32_t seed,
                     int x0, int y0, ImageRgbF& picture);
// How far from any coverage pixels may change.
int CameraLookReach(const CameraLook& look);

}  // namespace lorgnette
