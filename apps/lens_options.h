// SPDX-License-Identifier: Apache-2.0
// A lens as a command line describes it: by its order, by its two surfaces, or by a lens file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "optics/media.h"

namespace CLI {
class App;
}

namespace lorgnette {

// Options of one lens. An order gives sphere, cylinder and axis; surfaces give radii.
struct LensOptions {
  std::optional<double> sphere_D;  // exact back vertex power
  double cylinder_D = 0;
  std::optional<double> axis_deg;     // TABO
  double prism_in = 0, prism_up = 0;  // prism dioptres
  double add_D = 0;
  std::string eye = "right";

  std::vector<double> front_radii_mm;  // with it: a lens by its surfaces; along the axis, across it
  std::vector<double> back_radii_mm;
  std::string lens_file;  // a lens by all that its surfaces are (apps/lens_surfaces.h)

  std::optional<std::string>
      medium;  // absent: CR-39, or the standard one nearest to an index given
  std::optional<double> index, index_e, abbe, density_g_cm3;  // in place of the medium's

  std::optional<double> base_D;  // F1 at the lens index
  std::string base_rule = "vogel";
  std::string chart;  // file, for the base rule "chart"; empty: ours
  std::string generator = "across", toric = "back", power = "exact";
  std::optional<double> aspheric_gaze_deg;
  std::optional<double> center_thickness_mm, min_center_mm, min_edge_mm;
  double diameter_mm = 60;

  std::string multifocal = "none";
  std::optional<double> segment_width_mm;
  double segment_top_mm = -4, segment_inset_mm = 2;
  double corridor_start_mm = -2, corridor_mm = 14, near_inset_mm = 2.5;
  bool thinning = false;

  std::string prism_by = "grinding";
  double max_decentration_mm = 10;

  std::optional<double> vertex_distance_mm;    // as worn, back vertex to cornea
  std::optional<double> refraction_vertex_mm;  // at which the power was found
  double pantoscopic_deg = 0, face_form_deg = 0;

  std::string coat = "none", tint_kind = "dip";
  std::optional<double> tint;  // luminous transmittance of the tinted glass alone
};

inline constexpr double kDefaultVertex_mm = 13;

// Refuses what no lens can have; errors name the option.
Status CheckRange(const char* option, double value, double min, double max);
Status CheckMaking(const LensOptions& options);
Status CheckPower(const LensOptions& options);

// The medium and how thin labs make it, with what was given in place of its own.
Result<MediumEntry> MediumOf(const LensOptions& options);
// Options that concern how a lens is made and worn, whatever its power.
void AddMakingOptions(CLI::App& command, LensOptions& options);
// Sphere, cylinder, axis, prism, addition.
void AddPowerOptions(CLI::App& command, LensOptions& options);
// Radii of a lens that exists, or its file.
void AddSurfaceOptions(CLI::App& command, LensOptions& options);

}  // namespace lorgnette
