// SPDX-License-Identifier: Apache-2.0
// A spectacle prescription as written, one eye or both.
#pragma once

#include <string>

#include "base/result.h"
#include "base/units.h"

namespace lorgnette {

struct EyePrescription {
  Diopters sphere;
  Diopters cylinder;       // either sign; 0 when spherical
  AxisDegrees axis;        // meaningful only when cylinder is not 0
  Diopters add;            // near addition, 0 when none
  PrismDiopters prism_in;  // horizontal component, base in (+) or out (-)
  PrismDiopters prism_up;  // vertical component, base up (+) or down (-)
};

struct Prescription {
  EyePrescription right;                     // OD
  EyePrescription left;                      // OS
  double pd_right_mm = 32, pd_left_mm = 32;  // monocular pupillary distances
  double vertex_distance_mm = 13;            // of the refraction: back vertex to cornea

  double pd_mm() const { return pd_right_mm + pd_left_mm; }
};

// Reads a prescription in our JSON (docs/prescription.md). `name` is the file's name for errors:
//   {"OD": {"sphere": -4.25, "cylinder": -0.75, "axis": 160}, "OS": {"sphere": -4.5}, "PD": 64}
// Unknown keys, values out of range and an axis without a cylinder are errors.
Result<Prescription> ParsePrescription(const std::string& json_text, const std::string& name);

}  // namespace lorgnette
