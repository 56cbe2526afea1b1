// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "optics/power_vector.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV026(CaseRun& run) {
  const auto axis_error = [](double cylinder) {
    // Residual of a cylinder turned by t: difference of two power vectors; its cylinder is 2|C| sin
    // t.
    double low = 0, high = 45;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      const PowerVector a = PowerVectorOf({Diopters(0), Diopters(-cylinder), AxisDegrees(90)});
      const PowerVector b =
          PowerVectorOf({Diopters(0), Diopters(-cylinder), AxisDegrees(90 + middle)});
      const double residual = 2 * std::hypot(a.j0 - b.j0, a.j45 - b.j45);
      (residual < 0.12 ? low : high) = middle;
    }
    return low;
  };
  run.Rounded("C 0.25", "deg", 14, 0, axis_error(0.25));
  run.Rounded("C 0.50", "deg", 7, 0, axis_error(0.50));
  run.Exact("C 0.25, closed form", "deg", DegreesFromRadians(std::asin(0.12 / 0.5)),
            axis_error(0.25));
}

}  // namespace

extern const Case kV026;
const Case kV026 = {"V026", "design", "Axis error that leaves 0.12 D of cylinder",
                    "OLA white paper on Z80.1-2005 (printed as about)", RunV026};

}  // namespace lorgnette::validation
