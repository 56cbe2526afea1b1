// SPDX-License-Identifier: Apache-2.0
#include "optics/tolerances.h"

#include <algorithm>
#include <cmath>

namespace lorgnette {

double MeridianTolerance(LensKind kind, Diopters power) {
  const double p = std::abs(power.value());
  if (kind == LensKind::kProgressive) return p <= 8.0 ? 0.16 : 0.02 * p;
  return p <= 6.5 ? 0.13 : 0.02 * p;
}

double CylinderTolerance(LensKind kind, Diopters cylinder) {
  const double c = std::abs(cylinder.value());
  if (kind == LensKind::kProgressive) return c <= 2.0 ? 0.16 : c <= 3.5 ? 0.18 : 0.05 * c;
  return c <= 2.0 ? 0.13 : c <= 4.5 ? 0.15 : 0.04 * c;
}

double AxisTolerance(Diopters cylinder) {
  const double c = std::abs(cylinder.value());
  if (c <= 0.25) return 14;
  if (c <= 0.50) return 7;
  if (c <= 0.75) return 5;
  return c <= 1.50 ? 3 : 2;
}

double AddTolerance(Diopters add) { return add.value() <= 4.0 ? 0.12 : 0.18; }

double PrismTolerance(Diopters power) {
  constexpr double kDisplacement_cm = 0.1;
  return std::max(0.33, kDisplacement_cm * std::abs(power.value()));
}

}  // namespace lorgnette
