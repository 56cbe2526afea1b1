// SPDX-License-Identifier: Apache-2.0
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV013(CaseRun& run) {
  const double front = 0.45 * (1.586 - 1) / 0.530;  // true power at the lens index
  run.Rounded("front power", "D", 0.50, 2, front);
  run.Rounded("back power, thin", "D", -7.50, 2, -7 - front);
  run.Rounded("back tool (1.530)", "D", -6.78, 2, (-7 - front) * 0.530 / (1.586 - 1));
}

}  // namespace

extern const Case kV013;
const Case kV013 = {
    "V013", "paraxial",
    "Polycarbonate -7.00 on a 0.45 base (tool index 1.530): surface powers and back tool",
    "Rx-Universe wiki, curves of a job", RunV013};

}  // namespace lorgnette::validation
