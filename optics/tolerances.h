// SPDX-License-Identifier: Apache-2.0
// How far a finished lens may be from its order: ANSI Z80.1-2015, single-vision and multifocal
// lenses (and progressive ones where they differ).
#pragma once

#include "base/units.h"

namespace lorgnette {

enum class LensKind { kSingleVision, kProgressive };

// Power in a principal meridian, D: 0.13 to 6.50 D, then 2 per cent (progressive 0.16 to 8.00).
double MeridianTolerance(LensKind kind, Diopters power);
// Cylinder, D: 0.13 to 2.00, 0.15 to 4.50, then 4 per cent (progressive 0.16, 0.18 to 3.50, 5).
double CylinderTolerance(LensKind kind, Diopters cylinder);
// Axis, degrees: 14, 7, 5, 3, 2 for cylinders to 0.25, 0.50, 0.75, 1.50 and above.
double AxisTolerance(Diopters cylinder);
// Near addition, D: 0.12 to 4.00, then 0.18.
double AddTolerance(Diopters add);
// Prism at the reference point, prism D: 0.33, or what 1.0 mm of displacement gives.
double PrismTolerance(Diopters power);

inline constexpr double kCenterThicknessTolerance_mm = 0.3;
inline constexpr double kBaseCurveTolerance_D = 0.75;

}  // namespace lorgnette
