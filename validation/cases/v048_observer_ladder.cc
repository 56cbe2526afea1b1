// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "optics/magnification.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV048(CaseRun& run) {
  const double f2 = -6 - 2 / (1 - 0.0015 / 1.6 * 2);
  Lens lens;
  lens.front = Surface(SphereSurface{0.002 / 0.6});
  lens.back = Surface(SphereSurface{f2 / 1000 / -0.6});
  lens.center_thickness_mm = 1.5;
  const ObserverGeometry geometry{500, 15.05};
  run.Rounded("thin", "1", 0.9194, 4, ObserverMagnificationThin(Diopters(-6), geometry));
  const double height[] = {6, 15, 20, 25};
  const double expected[] = {0.92273, 0.92657, 0.93046, 0.93606};
  for (int i = 0; i < 4; ++i) {
    const auto ray = ObserverExact(lens, 1.6, geometry, {height[i], 0});
    run.Rounded("exact, feature " + std::to_string(int(height[i])) + " mm off the axis", "1",
                expected[i], 5, ray ? ray->magnification : 0);
  }
}

}  // namespace

extern const Case kV048;
const Case kV048 = {"V048", "magnification",
                    "C8: thin, thick and exact magnification by height, -6 D",
                    "derived; exact rays to 1e-19 (printed with five decimals)", RunV048};

}  // namespace lorgnette::validation
