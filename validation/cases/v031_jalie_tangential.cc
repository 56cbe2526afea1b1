// SPDX-License-Identifier: Apache-2.0
#include "validation/case.h"
#include "validation/made_lens.h"

namespace lorgnette::validation {
namespace {

void RunV031(CaseRun& run) {
  const double f1 = 8.5 / (1 + 0.004 / 1.523 * 8.5);
  const GazeVergence gaze = GazeAt(SpherePair(f1, -4.5, 4, 1.523), 35, 27);
  run.Within("tangential power", "D", 4, gaze.tangential_D, 0.05, "n, t and s are not stated");
}

}  // namespace

extern const Case kV031;
const Case kV031 = {"V031", "gaze", "+4.00 with a -4.50 back: least tangential error at 35 deg",
                    "perret-optic.ch (Jalie, best form); n, t and s are not stated", RunV031};

}  // namespace lorgnette::validation
