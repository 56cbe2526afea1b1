// SPDX-License-Identifier: Apache-2.0
// A spectacle prescription as written, one eye or both.
#pragma once

#include <optional>
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
  // Of each pupil above the lowest point of its lens (boxing); absent: the frame's mid-line.
  std::optional<double> fitting_height_right_mm, fitting_height_left_mm;

  double pd_mm() const { return pd_right_mm + pd_left_mm; }
};

// What a prescription may say; anything beyond is an error that names the key.
inline constexpr double kMaxSphere = 40, kMaxCylinder = 15, kMaxAdd = 6;  // D
inline constexpr double kMaxPrism = 20;                                   // prism D
inline constexpr double kMinPd_mm = 40, kMaxPd_mm = 85;
inline constexpr double kMinVertex_mm = 5, kMaxVertex_mm = 25;
inline constexpr double kMinFittingHeight_mm = 5, kMaxFittingHeight_mm = 60;

// Reads a prescription in our JSON (docs/prescription.md). `name` is the file's name for errors:
//   {"OD": {"sphere": -4.25, "cylinder": -0.75, "axis": 160}, "OS": {"sphere": -4.5}, "PD": 64}
// Per eye: sphere (required), cylinder with axis, add, and prism_in/prism_up or
// "prism": [{"amount": 1.5, "base": "in"}]. PD is binocular, or {"right": 31.5, "left": 32.5};
// fitting_height is one number for both eyes, or {"right": 21, "left": 21.5}.
// Unknown keys, values out of range, an axis without a cylinder and a cylinder without an axis are
// errors.
Result<Prescription> ParsePrescription(const std::string& json_text, const std::string& name);
// The same form; every number so that reading gives it back to the last bit.
std::string WritePrescription(const Prescription& rx);

}  // namespace lorgnette
