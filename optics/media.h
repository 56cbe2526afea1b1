// SPDX-License-Identifier: Apache-2.0
// Lens materials: index at both reference lines, dispersion, density, and how thin they may get.
//
// Trade names such as "1.60" are n_e values; lenses here are computed at the d line (587.56 nm), at
// which that material has 1.594: confusing them costs one per cent of power. Source:
// docs/optics.md, "Media".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "optics/lens.h"

namespace lorgnette {

// Spectral lines, nm.
inline constexpr double kLineD_nm = 587.56, kLineE_nm = 546.07;
inline constexpr double kLineF_nm = 486.13, kLineC_nm = 656.27;  // of V_d

struct MediumEntry {
  Medium medium;
  double min_center_mm = 2;  // least centre thickness that labs make
  double min_edge_mm = 1;    // of plus lenses
  std::vector<std::string> aliases;
};

// CR-39, crown glass, Trivex, polycarbonate, 1.60, 1.67 and 1.74.
const std::vector<MediumEntry>& StandardMedia();
// By name or alias, letter case and punctuation aside ("cr39", "Poly", "1.67"); an error lists what
// there is.
Result<MediumEntry> FindMedium(std::string_view name);

// A medium of the user's own. index_d must exceed 1, abbe be in 10..100, density in 0.5..8.
Result<Medium> MakeMedium(const std::string& name, double index_d, double abbe,
                          double density_g_cm3);
// The same from an index stated at the e line.
Result<Medium> MakeMediumFromE(const std::string& name, double index_e, double abbe,
                               double density_g_cm3);

// Refractive index by Cauchy's formula n = A + B / lambda^2 through n_d with the Abbe number V:
// B = (n_d - 1) / V / (1 / lambda_F^2 - 1 / lambda_C^2). Exact at d, about 1e-3 at 400 nm.
double IndexAt(const Medium& medium, double wavelength_nm);

}  // namespace lorgnette
