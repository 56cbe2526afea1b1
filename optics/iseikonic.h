// SPDX-License-Identifier: Apache-2.0
// A pair of lenses that magnify alike: when two eyes need different powers, the images differ in
// size (aniseikonia); more base curve and thickness on one lens brings them together.
//
// Spectacle magnification = shape factor 1 / (1 - tau F1) times power factor 1 / (1 - d F'v); the
// powers are prescribed, so the shape factor is what a designer can choose. Source:
// docs/measurement.md, "Magnification".
#pragma once

#include "base/result.h"
#include "base/units.h"

namespace lorgnette {

struct IseikonicEye {
  Diopters back_vertex_power;  // of a spherical lens, or of the meridian that matters
  double pupil_mm = 16.05;     // back vertex to entrance pupil: vertex distance + 3.05
  Diopters base_curve{4};      // as it would be ordered without the other eye; above 0
  double thickness_mm = 2;     // the same
};

struct IseikonicOrder {
  IseikonicEye right, left;
  double index = 1.5;
  double ratio = 1;             // wanted: magnification of the right lens over that of the left
  Diopters max_base_curve{14};  // what can be made and worn
  double max_thickness_mm = 9;
};

struct IseikonicLens {
  Diopters base_curve, back_power;
  double thickness_mm = 0;
  double magnification = 0;  // spectacle magnification, distant object
};

struct IseikonicPair {
  IseikonicLens right, left;
  double ratio_before = 1;  // of the lenses as ordered
  double ratio = 1;         // of the pair designed: the wanted one, but for rounding
};

// Leaves the lens that magnifies enough as it is; the other one gets base curve and thickness
// raised in the same proportion, each up to its limit. Fails, naming the ratio that can be reached,
// when the limits do not allow the wanted one.
Result<IseikonicPair> DesignIseikonicPair(const IseikonicOrder& order);

}  // namespace lorgnette
