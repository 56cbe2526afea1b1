// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "optics/power_vector.h"
#include "optics/prism.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV018(CaseRun& run) {
  const auto prism = [](double sphere, double cylinder, double axis, double x_mm, double y_mm) {
    const Eigen::Matrix2d f =
        LensFrameMatrix(PowerVectorOf({Diopters(sphere), Diopters(cylinder), AxisDegrees(axis)}));
    return PrenticePrism(f, {x_mm, y_mm});
  };
  run.Exact("horizontal", "prism D", 1.75, std::abs(prism(5, -1.5, 90, 5, 0).x()), 12);
  run.Exact("vertical", "prism D", 0, prism(5, -1.5, 90, 5, 0).y(), 12);
}

}  // namespace

extern const Case kV018;
const Case kV018 = {"V018", "prism", "Prentice: +5.00 -1.50 x 90, 5 mm to the side",
                    "nfos.org, answers 13a", RunV018};

}  // namespace lorgnette::validation
