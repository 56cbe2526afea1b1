// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV011(CaseRun& run) {
  run.Rounded("meridian of +10", "D", 10 / 1.02, 4, MovedTowardEye(Diopters(10), -2).value());
  run.Rounded("meridian of +8", "D", 8 / 1.016, 4, MovedTowardEye(Diopters(8), -2).value());
}

}  // namespace

extern const Case kV011;
const Case kV011 = {"V011", "paraxial",
                    "+10.00 -2.00 moved from 12 to 14 mm, by principal meridian",
                    "unit test of a public optical library (low authority)", RunV011};

}  // namespace lorgnette::validation
