// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV001(CaseRun& run) {
  const ParaxialSystem lens = ParaxialSystem::ThickLens(Diopters(10.25), Diopters(-3), 4, 1.586);
  run.Rounded("back vertex power", "D", 7.52, 2, lens.BackVertexPower().value());
}

}  // namespace

extern const Case kV001;
const Case kV001 = {"V001", "paraxial",
                    "Back vertex power of a +10.25/-3.00 meniscus, n 1.586, 4 mm",
                    "opticaled.com, back vertex power", RunV001};

}  // namespace lorgnette::validation
