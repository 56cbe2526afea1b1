// SPDX-License-Identifier: Apache-2.0
// A lens as a sequential Zemax file (.zmx, text), for OpticStudio and for readers of its format.
#pragma once

#include <string>

#include "base/result.h"
#include "optics/design.h"

namespace lorgnette {

// Object at infinity, the two surfaces, the eye's centre of rotation `stop_mm` behind the back
// vertex as the stop, and the image on the far-point plane of the back vertex power (at infinity: 1
// m behind). Lens frame and the file's axes are the same (+z along the light, +y up, right-handed).
// Spheres and conics are STANDARD, conics with even terms EVENASPH, tori TOROIDAL between
// coordinate breaks that turn their generator to y; ground prism is a pair of coordinate breaks
// about the back. Glass is a model glass of index n_d and V_d. Fails for surfaces that the format
// has no exact word for (atoroid, bifocal, progressive, grid).
Result<std::string> ZmxOf(const LensDesign& design, double stop_mm);

}  // namespace lorgnette
