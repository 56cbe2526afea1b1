// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV008(CaseRun& run) {
  const double spectacle[] = {4, 6, 8, 10}, cornea[] = {4.20, 6.47, 8.85, 11.36};
  for (int i = 0; i < 4; ++i) {
    run.Rounded("power at the cornea", "D", cornea[i], 2,
                MovedTowardEye(Diopters(spectacle[i]), 12).value());
  }
}

}  // namespace

extern const Case kV008;
const Case kV008 = {"V008", "paraxial", "Plus spectacle powers at the cornea, from 12 mm",
                    "clevercalc, contact lens table", RunV008};

}  // namespace lorgnette::validation
