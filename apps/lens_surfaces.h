// SPDX-License-Identifier: Apache-2.0
// Lenses that exist: by radii on the command line, or by a lens file.
#pragma once

#include "apps/lens_options.h"
#include "base/result.h"
#include "optics/design.h"

namespace lorgnette {

// Two spheres or tori. The order of the design says what the lens amounts to.
Result<LensDesign> LensFromRadii(const LensOptions& options);

// Any two surfaces of optics/surface_shapes.h, SDF grids among them, from a JSON file
// (docs/command-line.md, "The lens file"). A path in it is relative to the file.
Result<LensDesign> LensFromFile(const LensOptions& options);

inline constexpr double kMinRadius_mm = 5;  // a surface more strongly curved is a mistake

}  // namespace lorgnette
