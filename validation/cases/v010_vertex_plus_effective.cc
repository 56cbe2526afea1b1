// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV010(CaseRun& run) {
  run.Rounded("+5 moved 10 mm", "D", 5.26, 2, MovedTowardEye(Diopters(5), 10).value());
  run.Rounded("+10 moved 20 mm", "D", 12.50, 2, MovedTowardEye(Diopters(10), 20).value());
}

}  // namespace

extern const Case kV010;
const Case kV010 = {"V010", "paraxial",
                    "Effective power of +5.00 after 10 mm and +10.00 after 20 mm",
                    "7search, effective power examples (low authority)", RunV010};

}  // namespace lorgnette::validation
