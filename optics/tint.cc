// SPDX-License-Identifier: Apache-2.0
#include "optics/tint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lorgnette {

double Tint::Transmittance(double wavelength_nm, double path_mm) const {
  if (absorbance.empty()) return 1;
  const auto after = std::lower_bound(
      absorbance.begin(), absorbance.end(), wavelength_nm,
      [](const std::pair<double, double>& entry, double w) { return entry.first < w; });
  double value;
  if (after == absorbance.begin()) {
    value = absorbance.front().second;
  } else if (after == absorbance.end()) {
    value = absorbance.back().second;
  } else {
    const auto before = after - 1;
    const double u = (wavelength_nm - before->first) / (after->first - before->first);
    value = before->second + u * (after->second - before->second);
  }
  return std::pow(10.0, -value * (kind == TintKind::kSolid ? path_mm : 1.0));
}

Result<Tint> GreyTint(TintKind kind, double luminous, double path_mm) {
  if (!(luminous > 0 && luminous <= 1)) {
    return UsageError(
        fmt::format("tint: transmittance: got {:g}, want above 0, at most 1", luminous));
  }
  if (kind == TintKind::kSolid && !(path_mm > 0)) {
    return UsageError(fmt::format("tint: path_mm: got {:g}, want above 0", path_mm));
  }
  const double absorbance = -std::log10(luminous) / (kind == TintKind::kSolid ? path_mm : 1.0);
  return Tint{kind, {{550, absorbance}}};
}

double LensTransmittance(const LensFilter& filter, double wavelength_nm, double cos_incident,
                         double path_mm) {
  const FilmStack front = CoatOn(filter.front_coat, filter.index);
  const FilmStack back = CoatOn(filter.back_coat, filter.index);
  const double sin_inside2 = (1 - cos_incident * cos_incident) / (filter.index * filter.index);
  const double cos_inside = std::sqrt(std::max(0.0, 1 - sin_inside2));
  const PolarizedPower in = FilmPower(front, wavelength_nm, cos_incident);
  const PolarizedPower again = FilmPower(Reversed(front), wavelength_nm, cos_inside);
  const PolarizedPower out = FilmPower(Reversed(back), wavelength_nm, cos_inside);
  const double glass = filter.tint.Transmittance(wavelength_nm, path_mm);
  const auto through = [&](double t1, double r1, double t2, double r2) {
    return t1 * glass * t2 / (1 - r1 * r2 * glass * glass);
  };
  return 0.5 *
         (through(in.ts, again.rs, out.ts, out.rs) + through(in.tp, again.rp, out.tp, out.rp));
}

double LuminousTransmittance(const LensFilter& filter, double cos_incident, double path_mm) {
  return LuminousFraction(Sampled([&](double wavelength_nm) {
    return LensTransmittance(filter, wavelength_nm, cos_incident, path_mm);
  }));
}

Spectrum CoatReflectance(CoatKind kind, double index, double cos_incident) {
  const FilmStack stack = CoatOn(kind, index);
  return Sampled([&](double wavelength_nm) {
    return FilmPower(stack, wavelength_nm, cos_incident).reflectance();
  });
}

std::optional<int> FilterCategory(double luminous_transmittance) {
  constexpr double kLowerLimits[] = {0.80, 0.43, 0.18, 0.08, 0.03};
  for (int category = 0; category < 5; ++category) {
    if (luminous_transmittance > kLowerLimits[category]) return category;
  }
  return std::nullopt;
}

}  // namespace lorgnette
