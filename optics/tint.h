// SPDX-License-Identifier: Apache-2.0
// Tints by Beer and Lambert, and the light that passes a tinted, coated lens.
//
// A solid tint absorbs along the path in the glass, so that thick zones are darker; a dip tint sits
// in both surfaces and does not know the thickness. Source: docs/measurement.md, "Tints".
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "base/result.h"
#include "optics/luminous.h"
#include "optics/thin_film.h"

namespace lorgnette {

enum class TintKind { kSolid, kDip };

struct Tint {
  TintKind kind = TintKind::kDip;
  // (wavelength nm, decadic absorbance), wavelengths rising; linear between, constant outside.
  // Absorbance per mm of path for kSolid, of the whole lens for kDip. Empty: clear.
  std::vector<std::pair<double, double>> absorbance;

  // 10^-absorbance after `path_mm` in the glass.
  double Transmittance(double wavelength_nm, double path_mm) const;
};

// The even grey whose glass alone transmits `luminous` (in 0..1, not 0) at `path_mm`.
Result<Tint> GreyTint(TintKind kind, double luminous, double path_mm);

// A lens as a filter: coats met from the air, tint between them.
struct LensFilter {
  double index = 1.5;
  CoatKind front_coat = CoatKind::kNone, back_coat = CoatKind::kNone;
  Tint tint;
};

// Both polarisations, every internal bounce (incoherent), plane-parallel at the point of passage.
//   cos_incident  in the air;  path_mm  along the ray in the glass
double LensTransmittance(const LensFilter& filter, double wavelength_nm, double cos_incident,
                         double path_mm);
// The same over the spectrum, weighed by the eye in daylight.
double LuminousTransmittance(const LensFilter& filter, double cos_incident, double path_mm);

// Light that one coat reflects in air, over the spectrum: its luminous fraction and colour tell how
// the residual looks, also obliquely.
Spectrum CoatReflectance(CoatKind kind, double index, double cos_incident);

// Filter category of sunglass standards (ISO 12312-1): 0 above 80 per cent, 1 above 43, 2 above 18,
// 3 above 8, 4 above 3; nullopt at or below 3, which is no spectacle lens.
std::optional<int> FilterCategory(double luminous_transmittance);

}  // namespace lorgnette
