// SPDX-License-Identifier: Apache-2.0
#include "optics/power_vector.h"
#include "optics/prism.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV017(CaseRun& run) {
  const auto prism = [](double sphere, double cylinder, double axis, double x_mm, double y_mm) {
    const Eigen::Matrix2d f =
        LensFrameMatrix(PowerVectorOf({Diopters(sphere), Diopters(cylinder), AxisDegrees(axis)}));
    return PrenticePrism(f, {x_mm, y_mm});
  };
  run.Exact("base up", "prism D", 4, prism(5, -1.5, 90, 0, -8).y(), 12);
  run.Exact("horizontal", "prism D", 0, prism(5, -1.5, 90, 0, -8).x(), 12);
}

}  // namespace

extern const Case kV017;
const Case kV017 = {"V017", "prism", "Prentice: +5.00 -1.50 x 90, 8 mm below the optical centre",
                    "nfos.org, answers 13a", RunV017};

}  // namespace lorgnette::validation
