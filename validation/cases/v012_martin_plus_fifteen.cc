// SPDX-License-Identifier: Apache-2.0
#include "optics/wear.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV012(CaseRun& run) {
  const SphereCylinder tilted =
      MartinTilted(Diopters(15), RadiansFromDegrees(10), 1.5, AxisDegrees(180));
  run.Rounded("sphere", "D", 15.15, 2, tilted.sphere.value());
  run.Rounded("cylinder", "D", 0.47, 2, tilted.cylinder.value());
  run.Exact("axis", "deg", 180, tilted.axis.value(), 12);
}

}  // namespace

extern const Case kV012;
const Case kV012 = {"V012", "wear", "Martin's rule for +15.00 D tilted by 10 deg, 2n = 3",
                    "Durham Technical Community College, lens tilt", RunV012};

}  // namespace lorgnette::validation
