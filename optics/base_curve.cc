// SPDX-License-Identifier: Apache-2.0
#include "optics/base_curve.h"

#include <algorithm>

namespace lorgnette {

Diopters VogelBaseCurve(Diopters spherical_equivalent) {
  const double se = spherical_equivalent.value();
  return Diopters(std::max(se > 0 ? se + 6 : se / 2 + 6, kFlattestRuleCurve_D));
}

Diopters SteepestBaseCurve(double rim_radius_mm, double index) {
  return Diopters::FromPerMm((index - 1) * kSteepestRimSine / rim_radius_mm);
}

}  // namespace lorgnette
