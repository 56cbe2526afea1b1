// SPDX-License-Identifier: Apache-2.0
#include "optics/power_vector.h"
#include "optics/prism.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV015(CaseRun& run) {
  const auto prism = [](double sphere, double cylinder, double axis, double x_mm, double y_mm) {
    const Eigen::Matrix2d f =
        LensFrameMatrix(PowerVectorOf({Diopters(sphere), Diopters(cylinder), AxisDegrees(axis)}));
    return PrenticePrism(f, {x_mm, y_mm});
  };
  run.Exact("base up", "prism D", 1.7, prism(8.5, 0, 180, 0, -2).y(), 12);
}

}  // namespace

extern const Case kV015;
const Case kV015 = {"V015", "prism", "Prentice: +8.50 D, 2 mm below the optical centre",
                    "nfos.org, answers 13a", RunV015};

}  // namespace lorgnette::validation
