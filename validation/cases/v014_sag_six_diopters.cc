// SPDX-License-Identifier: Apache-2.0
#include "optics/surface.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV014(CaseRun& run) {
  const Surface surface(SphereSurface{0.006 / 0.53});
  run.Within("parabola", "mm", 3.5, 25.0 * 25 / 2 * 0.006 / 0.53, 0.05, "printed as about 3.5");
  const auto jet = surface.Jet(25, 0);
  run.Rounded("sphere", "mm", 3.612, 3, jet ? jet->z : 0);
}

}  // namespace

extern const Case kV014;
const Case kV014 = {"V014", "paraxial",
                    "Sag of a 6.00 D curve at 50 mm diameter, n 1.53: approximate and exact",
                    "open examination paper; exact value derived", RunV014};

}  // namespace lorgnette::validation
