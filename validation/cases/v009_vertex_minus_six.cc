// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV009(CaseRun& run) {
  run.Rounded("power at the cornea", "D", -5.59, 2, MovedTowardEye(Diopters(-6), 12).value(), 1);
}

}  // namespace

extern const Case kV009;
const Case kV009 = {"V009", "paraxial", "-6.00 D at the cornea, from 12 mm",
                    "clevercalc, contact lens example (cut off, not rounded)", RunV009};

}  // namespace lorgnette::validation
