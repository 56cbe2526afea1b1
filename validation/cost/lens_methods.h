// SPDX-License-Identifier: Apache-2.0
// Ways of following a camera's rays through a lens, from none at all to double with dispersion.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/result.h"
#include "validation/cost/camera_lens.h"

namespace lorgnette::validation {

// One way, ready to run: `trace` does all rays of the picture and is what is timed; `answer` says
// what the last run found.
struct LensMethod {
  std::string method, parameter;
  std::function<void()> trace;
  std::function<LensAnswer()> answer;
};

// No lens, thin lens, thick lens (2x2 system matrices of the astigmatic lens).
std::vector<LensMethod> WarpMethods(const Lens& lens, const CameraRays& rays);
// Exact rays every 2 to 32 pixels, interpolated between.
std::vector<LensMethod> MapMethods(const Lens& lens, const CameraRays& rays);
// The analytic surfaces: SIMD kernel in float and double, one ray at a time, with dispersion.
std::vector<LensMethod> AnalyticMethods(const Lens& lens, const CameraRays& rays);
// Meshes of 1 k to 1 M triangles in Embree, with the normals of their facets and with interpolated
// ones, and the surfaces themselves as Embree's user geometry. `most` leaves out meshes of more
// triangles.
Result<std::vector<LensMethod>> MeshMethods(const Lens& lens, const CameraRays& rays, int most);

}  // namespace lorgnette::validation
