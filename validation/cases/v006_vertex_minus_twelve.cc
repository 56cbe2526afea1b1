// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV006(CaseRun& run) {
  run.Rounded("compensated power", "D", -12.61, 2, MovedTowardEye(Diopters(-12), -4).value());
}

}  // namespace

extern const Case kV006;
const Case kV006 = {"V006", "paraxial", "-12.00 D moved from 10 to 14 mm",
                    "brainscape deck on spectacle magnification", RunV006};

}  // namespace lorgnette::validation
