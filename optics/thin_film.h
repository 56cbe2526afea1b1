// SPDX-License-Identifier: Apache-2.0
// Thin-film stacks by the characteristic matrix: anti-reflection coats at any angle and colour.
//
// Per layer M = [cos d, i sin d / eta; i eta sin d, cos d] with d = 2 pi n t cos / lambda and
// eta = n cos (s) or n / cos (p). Absorbing layers have the index n - i k. Source:
// docs/measurement.md, "Thin films". Tested: quarter-wave closed forms, energy balance at every
// angle and polarisation, the bare surface as the empty stack.
#pragma once

#include <vector>

#include "optics/fresnel.h"

namespace lorgnette {

struct FilmLayer {
  double index = 1.38;
  double thickness_nm = 0;
  double extinction = 0;  // k >= 0
};

// Layers in the order that light meets them.
struct FilmStack {
  double index_before = 1;
  std::vector<FilmLayer> layers;
  double index_after = 1.5;
};
// The same stack met from the other side.
FilmStack Reversed(const FilmStack& stack);

// cos_incident in [0, 1] in the medium before; total reflection gives 1 and 0.
PolarizedPower FilmPower(const FilmStack& stack, double wavelength_nm, double cos_incident);

// Thickness of a quarter wave at normal incidence.
inline double QuarterWave_nm(double index, double wavelength_nm) {
  return wavelength_nm / (4 * index);
}

// Coats that opticians sell, on a substrate of this index, met from the air; design wavelength nm.
// kSingle: one quarter wave of MgF2 (1.38). kVCoat: two layers (1.46 on 2.10) with no reflection at
// the design wavelength. kBroadband: quarter, half, quarter (1.38, 2.10, 1.38 sqrt(n)).
enum class CoatKind { kNone, kSingle, kVCoat, kBroadband };
FilmStack CoatOn(CoatKind kind, double substrate_index, double design_nm = 550);

}  // namespace lorgnette
