// SPDX-License-Identifier: Apache-2.0
#include "optics/magnification.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV005(CaseRun& run) {
  const double shape = ShapeFactor(Diopters(4), 2, 1.498);
  const double power = PowerFactor(Diopters(-3), 15);
  run.Rounded("shape factor", "1", 1.005, 3, shape);
  run.Rounded("power factor", "1", 0.957, 3, power);
  run.Rounded("spectacle magnification", "1", 0.962, 3, shape * power);
}

}  // namespace

extern const Case kV005;
const Case kV005 = {"V005", "magnification",
                    "Shape, power factor and spectacle magnification, -3.00 D",
                    "brainscape deck on spectacle magnification", RunV005};

}  // namespace lorgnette::validation
