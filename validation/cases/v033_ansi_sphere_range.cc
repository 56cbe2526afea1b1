// SPDX-License-Identifier: Apache-2.0
#include "optics/tolerances.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV033(CaseRun& run) {
  const double tolerance = MeridianTolerance(LensKind::kSingleVision, Diopters(-3));
  run.Rounded("weakest", "D", -2.87, 2, -3 + tolerance);
  run.Rounded("strongest", "D", -3.13, 2, -3 - tolerance);
}

}  // namespace

extern const Case kV033;
const Case kV033 = {"V033", "design", "Range of a -3.00 D lens by ANSI Z80.1",
                    "opticianstudy, Z80.1 tolerances", RunV033};

}  // namespace lorgnette::validation
