// SPDX-License-Identifier: Apache-2.0
#include "validation/case.h"
#include "validation/made_lens.h"

namespace lorgnette::validation {
namespace {

void RunV046(CaseRun& run) {
  const auto thickness = [&](double power, double index, double f1, double diameter) {
    const auto lens = RoundDesign(power, index, f1, diameter);
    return lens ? lens->lens.center_thickness_mm : 0;
  };
  run.Rounded("+4", "mm", 5.5657796, 7, thickness(4, 1.498, 8, 65));
  run.Rounded("+6", "mm", 6.4930561, 7, thickness(6, 1.6, 9, 65));
  run.Rounded("+8", "mm", 6.5384538, 7, thickness(8, 1.67, 11, 60));
}

}  // namespace

extern const Case kV046;
const Case kV046 = {"V046", "design", "C6: centre thickness of plus lenses with a 1 mm edge",
                    "derived with 30 digits", RunV046};

}  // namespace lorgnette::validation
