// SPDX-License-Identifier: Apache-2.0
// The front curve of a lens, by rule. Powers are true ones at the lens' own index.
#pragma once

#include "base/units.h"

namespace lorgnette {

// Vogel's rule: spherical equivalent + 6 D for plus lenses, half of it + 6 D for minus lenses, kept
// to kFlattestRuleCurve_D or steeper. Source: docs/optics.md, "Form".
inline constexpr double kFlattestRuleCurve_D = 0.5;
Diopters VogelBaseCurve(Diopters spherical_equivalent);

// Steepest curve that still has a real front surface with a margin over a lens of this radius: the
// sag's slope angle there stays below asin(kSteepestRimSine).
inline constexpr double kSteepestRimSine = 0.85;
Diopters SteepestBaseCurve(double rim_radius_mm, double index);

}  // namespace lorgnette
