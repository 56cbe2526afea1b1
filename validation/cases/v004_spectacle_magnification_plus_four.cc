// SPDX-License-Identifier: Apache-2.0
#include "optics/magnification.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV004(CaseRun& run) {
  const double shape = ShapeFactor(Diopters(8), 4, 1.498);
  const double power = PowerFactor(Diopters(4), 15);
  run.Rounded("shape factor", "1", 1.022, 3, shape);
  run.Rounded("power factor", "1", 1.064, 3, power);
  run.Rounded("spectacle magnification", "1", 1.087, 3, shape * power);
}

}  // namespace

extern const Case kV004;
const Case kV004 = {"V004", "magnification",
                    "Shape, power factor and spectacle magnification, +4.00 D",
                    "brainscape deck on spectacle magnification", RunV004};

}  // namespace lorgnette::validation
