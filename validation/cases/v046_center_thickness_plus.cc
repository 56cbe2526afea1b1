// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "optics/design.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void Run(CaseRun& run) {
  const auto design = [](double power, double index, double f1, double diameter,
                         std::optional<double> thickness) {
    LensOrder order;
    order.rx.sphere = Diopters(power);
    order.medium.index_d = index;
    order.medium.density_g_cm3 = 1.30;
    order.base_curve = Diopters(f1);
    order.diameter_mm = diameter;
    order.center_thickness_mm = thickness;
    order.min_center_thickness_mm = 1;
    return DesignLens(order);
  };
  const auto thickness = [&](double power, double index, double f1, double diameter) {
    const auto lens = design(power, index, f1, diameter, std::nullopt);
    return lens ? lens->lens.center_thickness_mm : 0;
  };
  run.Rounded("+4", "mm", 5.5657796, 7, thickness(4, 1.498, 8, 65));
  run.Rounded("+6", "mm", 6.4930561, 7, thickness(6, 1.6, 9, 65));
  run.Rounded("+8", "mm", 6.5384538, 7, thickness(8, 1.67, 11, 60));
}

}  // namespace

extern const Case kV046;
const Case kV046 = {"V046", "design", "C6: centre thickness of plus lenses with a 1 mm edge",
                    "derived with 30 digits", Run};

}  // namespace lorgnette::validation
