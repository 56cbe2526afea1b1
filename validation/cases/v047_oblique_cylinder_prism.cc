// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "optics/power_vector.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV047(CaseRun& run) {
  const Eigen::Matrix2d f =
      LensFrameMatrix(PowerVectorOf({Diopters(-2.5), Diopters(5), AxisDegrees(135)}));
  run.Exact("Fxx", "D", 0, f(0, 0), 12);
  run.Exact("|Fxy|", "D", 2.5, std::abs(f(0, 1)), 12);
  // Base = -F r with r in cm.
  const Eigen::Vector2d base = -f * Eigen::Vector2d(0, -1.2);
  run.Exact("horizontal prism", "prism D", 3, std::abs(base.x()), 12);
  run.Exact("vertical prism", "prism D", 0, base.y(), 12);
}

}  // namespace

extern const Case kV047;
const Case kV047 = {"V047", "prism",
                    "C7: prism 12 mm below the centre of -2.50 +5.00 x 135 lies purely across",
                    "derived; Prentice through the power matrix, checked by rays", RunV047};

}  // namespace lorgnette::validation
