// SPDX-License-Identifier: Apache-2.0
#include "optics/power_vector.h"
#include "optics/prism.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV016(CaseRun& run) {
  const auto prism = [](double sphere, double cylinder, double axis, double x_mm, double y_mm) {
    const Eigen::Matrix2d f =
        LensFrameMatrix(PowerVectorOf({Diopters(sphere), Diopters(cylinder), AxisDegrees(axis)}));
    return PrenticePrism(f, {x_mm, y_mm});
  };
  run.Rounded("-3.25 D", "prism D", 1.6, 1, prism(-3.25, 0, 180, 0, 5).norm());
  run.Exact("+7.75 D", "prism D", 3.1, prism(7.75, 0, 180, 0, 4).norm(), 12);
}

}  // namespace

extern const Case kV016;
const Case kV016 = {"V016", "prism", "Prentice: -3.25 D at 5 mm and +7.75 D at 4 mm",
                    "nfos.org, answers 13a", RunV016};

}  // namespace lorgnette::validation
