// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV034(CaseRun& run) {
  const double index = 1.691;
  const ParaxialSystem lens =
      ParaxialSystem::ThickLens(Diopters(1000 * (index - 1) / 63.73364157),
                                Diopters(1000 * (1 - index) / 653.2939232), 10, index);
  // d(EFL)/dn = -EFL / (n - 1), and the index is printed as 1.6910.
  run.Within("focal length", "mm", 101.501826, 1000 / lens.EquivalentPower().value(),
             101.5 / (index - 1) * 5e-5, "index known to 5e-5");
}

}  // namespace

extern const Case kV034;
const Case kV034 = {"V034", "programs", "Focal length of a biconvex singlet, n 1.691",
                    "Zemax and Optiland, optiland issue 710; the index is printed with five digits",
                    RunV034};

}  // namespace lorgnette::validation
