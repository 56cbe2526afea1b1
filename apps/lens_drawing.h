// SPDX-License-Identifier: Apache-2.0
// A lens drawing: the lens from the front with its optical centre and axis, sections through both
// principal meridians with radii and thicknesses, to scale, the numbers beside them, and maps of
// what the turning eye meets beneath (apps/lens_maps.h). SVG.
#pragma once

#include <string>
#include <vector>

#include "apps/lens_text.h"

namespace lorgnette {

// One row a lens. Lengths are drawn at kDrawingScale; the outline is the one of the order.
std::string LensDrawingSvg(const std::vector<SheetColumn>& lenses);

inline constexpr double kDrawingScale = 4;  // SVG units a mm

}  // namespace lorgnette
