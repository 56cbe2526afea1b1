// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV003(CaseRun& run) {
  const ParaxialSystem lens = ParaxialSystem::ThickLens(Diopters(16), Diopters(-2), 11.4, 1.532);
  run.Rounded("equivalent power", "D", 14.24, 2, lens.EquivalentPower().value());
  run.Rounded("back vertex power", "D", 16.16, 2, lens.BackVertexPower().value());
  run.Rounded("back vertex focal length", "cm", 6.2, 1, 100 / lens.BackVertexPower().value());
}

}  // namespace

extern const Case kV003;
const Case kV003 = {
    "V003", "paraxial",
    "Equivalent and vertex power, focal length of a +16.00/-2.00 lens, n 1.532, 11.4 mm",
    "questionai, thick lens exercise", RunV003};

}  // namespace lorgnette::validation
