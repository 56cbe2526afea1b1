// SPDX-License-Identifier: Apache-2.0
#include "validation/case.h"
#include "validation/made_lens.h"

namespace lorgnette::validation {
namespace {

void RunV029(CaseRun& run) {
  const double f1 = 10 / (1 + 0.004 / 1.523 * 10);  // F1 / (1 - tau F1) = 10
  const GazeVergence gaze = GazeAt(SpherePair(f1, -6, 4, 1.523), 35, 27);
  run.Within("oblique astigmatism", "D", 0, gaze.tangential_D - gaze.sagittal_D, 0.05,
             "n, t and s are not stated");
  run.Within("mean power", "D", 3.75, (gaze.tangential_D + gaze.sagittal_D) / 2, 0.05,
             "n, t and s are not stated");
}

}  // namespace

extern const Case kV029;
const Case kV029 = {"V029", "gaze", "+4.00 with a -6.00 back: point-focal at 35 deg",
                    "perret-optic.ch (Jalie, best form); n, t and s are not stated", RunV029};

}  // namespace lorgnette::validation
