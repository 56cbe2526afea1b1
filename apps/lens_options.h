// SPDX-License-Identifier: Apache-2.0
// A lens as a command line describes it: by its order, or by its two surfaces.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "optics/design.h"

namespace CLI {
class App;
}

namespace lorgnette {

// Options of one lens. An order gives sphere, cylinder and axis; surfaces give radii.
struct LensOptions {
  std::optional<double> sphere_D;  // exact back vertex power
  double cylinder_D = 0;
  std::optional<double> axis_deg;         // TABO
  double prism_in = 0, prism_up = 0;      // prism dioptres
  std::optional<double> base_D;           // F1 at the lens index
  std::optional<double> front_radius_mm;  // with it: a lens by its surfaces
  std::vector<double> back_radii_mm;      // along the axis, and across it
  std::optional<double> center_thickness_mm;
  std::string eye = "right";
  std::string generator = "across", toric = "back", base_rule = "vogel";
  std::string chart;  // file, for the base rule "chart"; empty: ours
  std::string medium = "CR-39";
  std::optional<double> index, density_g_cm3;  // in place of the medium's
  std::optional<double> aspheric_gaze_deg;
  double diameter_mm = 60;
  double vertex_distance_mm = 13;
};

// The medium by name, with the index and the density given in place of its own.
Result<Medium> MediumFromOptions(const std::string& name, std::optional<double> index,
                                 std::optional<double> density_g_cm3);

// Options that concern how a lens is made, whatever its power.
void AddMakingOptions(CLI::App& command, LensOptions& options);
// Sphere, cylinder, axis, prism.
void AddPowerOptions(CLI::App& command, LensOptions& options);
// Radii of a lens that exists.
void AddSurfaceOptions(CLI::App& command, LensOptions& options);

// Check ranges; errors name the option. The second takes the power from `rx`.
Result<LensOrder> OrderFromOptions(const LensOptions& options);
Result<LensOrder> OrderFromPrescription(const EyePrescription& rx, Eye eye,
                                        const LensOptions& options);

// The designed lens, or the lens of the given surfaces, whose order then says what it is.
Result<LensDesign> LensFromOptions(const LensOptions& options);

}  // namespace lorgnette
