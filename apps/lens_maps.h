// SPDX-License-Identifier: Apache-2.0
// Maps of what the turning eye meets over a lens, as bands with labelled contour lines, for the
// lens drawing: mean power, cylinder with its axis, prism, distortion, lateral colour.
#pragma once

#include "apps/svg.h"
#include "optics/lens.h"

namespace lorgnette {

inline constexpr double kMapHalfAngle_deg = 30;
inline constexpr double kMapRowHeight = 268;  // SVG units

// Five discs in a row below `top`, from x = 24 to the width of the lens drawing. Seen from the
// front, as the lens beside them: the wearer's right is at the left.
void DrawMaps(const Lens& lens, double stop_mm, double top, Svg& svg);

}  // namespace lorgnette
