// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV028(CaseRun& run) {
  const ParaxialSystem eye = ParaxialSystem::Refraction(Diopters(60));
  run.Rounded("front focal length", "mm", -16.67, 2, -1000 / eye.EquivalentPower().value());
  run.Rounded("back focal length", "mm", 22.22, 2,
              1000 * (4.0 / 3) / eye.EquivalentPower().value());
}

}  // namespace

extern const Case kV028;
const Case kV028 = {"V028", "paraxial", "Focal lengths of the 60 D reduced eye, n 4/3",
                    "brainscape deck on the schematic eye", RunV028};

}  // namespace lorgnette::validation
