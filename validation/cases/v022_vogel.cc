// SPDX-License-Identifier: Apache-2.0
#include "optics/base_curve.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV022(CaseRun& run) {
  run.Rounded("+2 -1", "D", 7.50, 2, VogelBaseCurve(Diopters(1.5)).value(), 1);
  run.Rounded("-2 -0.5", "D", 4.87, 2, VogelBaseCurve(Diopters(-2.25)).value(), 1);
}

}  // namespace

extern const Case kV022;
const Case kV022 = {"V022", "design", "Base curve by Vogel for +2.00 -1.00 and -2.00 -0.50",
                    "brainscape deck on Vogel (cut off, not rounded)", RunV022};

}  // namespace lorgnette::validation
