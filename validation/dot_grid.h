// SPDX-License-Identifier: Apache-2.0
// Magnification through the whole picture: a dot grid in the plane of the iris, rendered by the
// compositor that makes the video, its dots found again in the output.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/result.h"
#include "optics/design.h"
#include "validation/case.h"

namespace lorgnette::validation {

struct DotGridOptions {
  double camera_mm = 600;  // from the plane of the corneal apices
  double focal_px = 5400;  // 9 px a mm at the iris: a close-up
  int size_px = 300;       // of the picture, square
  double spacing_mm = 2;   // of the dots
  int reach = 6;           // dots on each side of the axis
  double dot_mm = 0.28;    // standard deviation of a dot's Gaussian
};

struct DotGridResult {
  int dots = 0, found = 0;  // wanted, and met by exactly one dot of the picture
  double worst_px = 0;      // farthest of them from its exact ray
  std::string worst_at;
  double mean_px = 0;
  // Spacing about the axis, measured over the thick lens to first order, less 1: the worse of the
  // two meridians.
  double spacing_error = 0;
  // Measured spacing over that without the lens, along x and along y.
  Eigen::Vector2d magnification{1, 1};
};

// Designs, certifies and mounts the lens on a straight axis 14 mm before the eye, renders, and
// measures. Fails when a step of that fails.
Result<DotGridResult> MeasureDotGrid(const LensOrder& order, const DotGridOptions& options = {});

// Centres of all dots in a picture: local maxima of its second channel above a third of the
// greatest, refined to the centre of light.
std::vector<Eigen::Vector2d> DetectDots(const ImageRgbF& image, double radius_px);

// Adds the checks that a dot case makes: every dot found, each within 0.02 pixel of its exact ray,
// spacing within 0.1 per cent of the thick lens where that applies.
inline constexpr double kDotTolerance_px = 0.02, kSpacingTolerance = 1e-3;
void CheckDotGrid(CaseRun& run, const LensOrder& order, bool spacing = true);

}  // namespace lorgnette::validation
