// SPDX-License-Identifier: Apache-2.0
// Where the canonical face is too deep or too flat.
#pragma once

#include <array>

#include "tracking/canonical_mesh.h"

namespace lorgnette {

// By how much each vertex of the canonical file has to come forward (mm at the scale of the file)
// to lie where scanned people have it: the landmark network was shown the mean head of ICT-FaceKit
// (USC ICT, MIT licence) in nine near-frontal poses, and the depth of the skin under each landmark
// taken, smoothed over 2 mm, and made symmetric. Across and in height both faces agree to 1 mm, in
// depth not: the file has the ridge of the nose 6 mm too far forward of the eyes
// (docs/tracking.md).
extern const std::array<double, kLandmarks> kScannedDepthMm;

}  // namespace lorgnette
