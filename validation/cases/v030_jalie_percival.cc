// SPDX-License-Identifier: Apache-2.0
#include "validation/case.h"
#include "validation/made_lens.h"

namespace lorgnette::validation {
namespace {

void RunV030(CaseRun& run) {
  const double f1 = 8 / (1 + 0.004 / 1.523 * 8);
  const GazeVergence gaze = GazeAt(SpherePair(f1, -4, 4, 1.523), 35, 27);
  run.Within("mean oblique error", "D", 0, (gaze.tangential_D + gaze.sagittal_D) / 2 - 4, 0.05,
             "n, t and s are not stated");
}

}  // namespace

extern const Case kV030;
const Case kV030 = {"V030", "gaze", "+4.00 with a -4.00 back: Percival form at 35 deg",
                    "perret-optic.ch (Jalie, best form); n, t and s are not stated", RunV030};

}  // namespace lorgnette::validation
