// SPDX-License-Identifier: Apache-2.0
// An uncut lens: two analytic surfaces, a medium, and the distance between them.
#pragma once

#include <string>

#include "optics/surface.h"

namespace lorgnette {

struct Medium {
  std::string name = "CR-39";
  double index_d = 1.498;  // at 587.56 nm; lenses are designed at this line unless told apart
  double abbe = 58;        // V_d
  double density_g_cm3 = 1.32;
};

// Front vertex at the origin of the lens frame, back vertex at z = center_thickness_mm.
struct Lens {
  Surface front;
  Surface back;
  double center_thickness_mm = 0;
  Medium medium;
  // Prism ground into the lens: the back surface is turned about its vertex by these angles
  // (radians; rotation about +x, then +y). Zero unless prism was ordered.
  double back_tilt_x = 0, back_tilt_y = 0;
};

}  // namespace lorgnette
