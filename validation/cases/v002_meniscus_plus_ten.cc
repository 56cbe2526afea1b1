// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV002(CaseRun& run) {
  const ParaxialSystem lens = ParaxialSystem::ThickLens(Diopters(15), Diopters(-6), 6.5, 1.523);
  run.Rounded("back vertex power", "D", 10.03, 2, lens.BackVertexPower().value());
}

}  // namespace

extern const Case kV002;
const Case kV002 = {"V002", "paraxial",
                    "Back vertex power of a +15.00/-6.00 meniscus, n 1.523, 6.5 mm",
                    "opticaled.com, back vertex power", RunV002};

}  // namespace lorgnette::validation
