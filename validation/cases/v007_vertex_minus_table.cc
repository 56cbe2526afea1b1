// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV007(CaseRun& run) {
  const double spectacle[] = {-4, -8, -10, -15}, cornea[] = {-3.82, -7.30, -8.93, -12.71};
  for (int i = 0; i < 4; ++i) {
    run.Rounded("power at the cornea", "D", cornea[i], 2,
                MovedTowardEye(Diopters(spectacle[i]), 12).value());
  }
}

}  // namespace

extern const Case kV007;
const Case kV007 = {"V007", "paraxial", "Minus spectacle powers at the cornea, from 12 mm",
                    "clevercalc, contact lens table", RunV007};

}  // namespace lorgnette::validation
