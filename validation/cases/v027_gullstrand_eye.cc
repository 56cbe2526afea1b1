// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV027(CaseRun& run) {
  // Radii (mm), vertex positions (mm) and indices: cornea, lens cortex, lens core, and back again.
  const double radius[] = {7.7, 6.8, 10, 7.911, -5.76, -6};
  const double position[] = {0, .5, 3.6, 4.146, 6.565, 7.2};
  const double index[] = {1, 1.376, 1.336, 1.386, 1.406, 1.386, 1.336};
  const auto refraction = [&](int i) {
    return ParaxialSystem::Refraction(Diopters(1000 * (index[i + 1] - index[i]) / radius[i]));
  };
  ParaxialSystem eye = refraction(0);
  for (int i = 1; i < 6; ++i) {
    eye =
        refraction(i) * ParaxialSystem::Transfer((position[i] - position[i - 1]) / index[i]) * eye;
  }
  run.Rounded("power", "D", 58.64, 2, eye.EquivalentPower().value());
  // The pupil stands at the lens's front vertex; the cornea images it.
  const ParaxialSystem cornea =
      refraction(1) * ParaxialSystem::Transfer(position[1] / index[1]) * refraction(0);
  const ParaxialSystem to_pupil =
      ParaxialSystem::Transfer((position[2] - position[1]) / index[2]) * cornea;
  // Rays through the pupil's centre: height 0 there, so the object height is -b/a per angle.
  run.Rounded("entrance pupil behind the cornea", "mm", 3.047, 3, 1000 * to_pupil.b_m / to_pupil.a);
  run.Rounded("pupil magnification", "1", 1.1333, 4, 1 / to_pupil.a);
}

}  // namespace

extern const Case kV027;
const Case kV027 = {
    "V027", "paraxial", "Power, entrance pupil and pupil magnification of the Gullstrand eye no. 1",
    "Gullstrand 1909 as tabulated in textbooks (figures from memory, recomputed)", RunV027};

}  // namespace lorgnette::validation
