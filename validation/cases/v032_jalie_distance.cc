// SPDX-License-Identifier: Apache-2.0
#include "validation/case.h"
#include "validation/made_lens.h"

namespace lorgnette::validation {
namespace {

void RunV032(CaseRun& run) {
  const double f2 = 4 - 7.5 / (1 - 0.004 / 1.498 * 7.5);
  const GazeVergence gaze = GazeAt(SpherePair(7.5, f2, 4, 1.498), 40, 27);
  run.Within("oblique astigmatism", "D", 0.40, gaze.tangential_D - gaze.sagittal_D, 0.05,
             "n, t and s are not stated");
  run.Within("mean oblique error", "D", 0, (gaze.tangential_D + gaze.sagittal_D) / 2 - 4, 0.05,
             "n, t and s are not stated");
}

}  // namespace

extern const Case kV032;
const Case kV032 = {"V032", "gaze", "+4.00 with a +7.50 front: 40 deg",
                    "tionet.in 2021 p106 (Jalie); n, t and s are not stated", RunV032};

}  // namespace lorgnette::validation
