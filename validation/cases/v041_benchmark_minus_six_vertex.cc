// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV041(CaseRun& run) {
  const ParaxialSystem lens =
      ParaxialSystem::ThickLens(Diopters(2), Diopters(-8.00375704445836), 1.5, 1.6);
  run.Exact("back vertex power", "D", -6, lens.BackVertexPower().value(), 12);
  run.Exact("equivalent power", "D", -5.98875, lens.EquivalentPower().value(), 12);
  run.Exact("front vertex power", "D", -5.944147953696, lens.FrontVertexPower().value(), 12);
  run.Exact("focal length", "mm", -166.979753704863, 1000 / lens.EquivalentPower().value(), 12);
}

}  // namespace

extern const Case kV041;
const Case kV041 = {
    "V041", "programs", "C1: -6.00 D, n 1.6, F1 +2, 1.5 mm: vertex and equivalent power",
    "derived with 30 digits; confirmed by Optiland, rayoptics, prysm, goptical", RunV041};

}  // namespace lorgnette::validation
