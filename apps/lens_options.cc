// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_options.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cmath>

#include "optics/prescription.h"

namespace lorgnette {
namespace {

constexpr double kMinIndex = 1.3, kMaxIndex = 2.2;
constexpr double kMinThickness_mm = 0.1, kMaxThickness_mm = 40;
constexpr double kMinDiameter_mm = 5, kMaxDiameter_mm = 120;
constexpr double kMaxBase_D = 25;
constexpr double kMaxTilt_deg = 30;
constexpr double kMaxDecentration_mm = 30;

// The standard medium whose index, at either line, is nearest.
const MediumEntry& NearestMedium(double index) {
  const auto& media = StandardMedia();
  const auto distance = [&](const MediumEntry& entry) {
    return std::min(std::abs(entry.medium.index_d - index),
                    std::abs(IndexAt(entry.medium, kLineE_nm) - index));
  };
  return *std::min_element(
      media.begin(), media.end(),
      [&](const MediumEntry& a, const MediumEntry& b) { return distance(a) < distance(b); });
}

}  // namespace

Status CheckRange(const char* option, double value, double min, double max) {
  if (value >= min && value <= max) return {};
  return UsageError(fmt::format("{}: got {}, want {}..{}", option, value, min, max));
}

Status CheckMaking(const LensOptions& o) {
  const auto check = [](const char* name, const std::optional<double>& value, double min,
                        double max) -> Status {
    return value ? CheckRange(name, *value, min, max) : Status();
  };
  LG_RETURN_IF_ERROR(check("--aspheric", o.aspheric_gaze_deg, 5, 45));
  LG_RETURN_IF_ERROR(CheckRange("--diameter", o.diameter_mm, kMinDiameter_mm, kMaxDiameter_mm));
  LG_RETURN_IF_ERROR(check("--vertex", o.vertex_distance_mm, kMinVertex_mm, kMaxVertex_mm));
  LG_RETURN_IF_ERROR(
      check("--refraction-vertex", o.refraction_vertex_mm, kMinVertex_mm, kMaxVertex_mm));
  LG_RETURN_IF_ERROR(check("--base", o.base_D, -kMaxBase_D, kMaxBase_D));
  LG_RETURN_IF_ERROR(
      check("--center-thickness", o.center_thickness_mm, kMinThickness_mm, kMaxThickness_mm));
  LG_RETURN_IF_ERROR(check("--min-center", o.min_center_mm, kMinThickness_mm, kMaxThickness_mm));
  LG_RETURN_IF_ERROR(check("--min-edge", o.min_edge_mm, 0, kMaxThickness_mm));
  LG_RETURN_IF_ERROR(check("--segment-width", o.segment_width_mm, 10, 60));
  LG_RETURN_IF_ERROR(CheckRange("--segment-top", o.segment_top_mm, -25, 0));
  LG_RETURN_IF_ERROR(CheckRange("--segment-inset", o.segment_inset_mm, -10, 10));
  LG_RETURN_IF_ERROR(CheckRange("--corridor", o.corridor_mm, 5, 30));
  LG_RETURN_IF_ERROR(CheckRange("--corridor-start", o.corridor_start_mm, -15, 0));
  LG_RETURN_IF_ERROR(CheckRange("--near-inset", o.near_inset_mm, -5, 8));
  LG_RETURN_IF_ERROR(CheckRange("--pantoscopic", o.pantoscopic_deg, -kMaxTilt_deg, kMaxTilt_deg));
  LG_RETURN_IF_ERROR(CheckRange("--face-form", o.face_form_deg, -kMaxTilt_deg, kMaxTilt_deg));
  LG_RETURN_IF_ERROR(
      CheckRange("--max-decentration", o.max_decentration_mm, 0, kMaxDecentration_mm));
  LG_RETURN_IF_ERROR(check("--tint", o.tint, 0.01, 1));
  return {};
}

Status CheckPower(const LensOptions& o) {
  LG_RETURN_IF_ERROR(CheckRange("--sphere", *o.sphere_D, -kMaxSphere, kMaxSphere));
  LG_RETURN_IF_ERROR(CheckRange("--cylinder", o.cylinder_D, -kMaxCylinder, kMaxCylinder));
  LG_RETURN_IF_ERROR(CheckRange("--prism-in", o.prism_in, -kMaxPrism, kMaxPrism));
  LG_RETURN_IF_ERROR(CheckRange("--prism-up", o.prism_up, -kMaxPrism, kMaxPrism));
  LG_RETURN_IF_ERROR(CheckRange("--add", o.add_D, 0, kMaxAdd));
  if (o.axis_deg) LG_RETURN_IF_ERROR(CheckRange("--axis", *o.axis_deg, 0, 180));
  if (o.cylinder_D != 0 && !o.axis_deg) {
    return UsageError("--cylinder: got a cylinder without --axis, want both");
  }
  if (o.cylinder_D == 0 && o.axis_deg) {
    return UsageError("--axis: got an axis without --cylinder, want both or neither");
  }
  return {};
}

Result<MediumEntry> MediumOf(const LensOptions& o) {
  if (o.index && o.index_e) {
    return UsageError("--index-e: got it together with --index, want the index at one line");
  }
  for (const auto& [name, index] : {std::pair{"--index", o.index}, {"--index-e", o.index_e}}) {
    if (index) LG_RETURN_IF_ERROR(CheckRange(name, *index, kMinIndex, kMaxIndex));
  }
  if (o.abbe) LG_RETURN_IF_ERROR(CheckRange("--abbe", *o.abbe, 10, 100));
  if (o.density_g_cm3) LG_RETURN_IF_ERROR(CheckRange("--density", *o.density_g_cm3, 0.5, 8));

  const std::optional<double> given = o.index ? o.index : o.index_e;
  MediumEntry entry;
  if (o.medium || !given) {
    LG_ASSIGN(entry, FindMedium(o.medium.value_or("CR-39")));
  } else {
    entry = NearestMedium(*given);
  }
  Medium& medium = entry.medium;
  if (o.abbe) medium.abbe = *o.abbe;
  if (o.density_g_cm3) medium.density_g_cm3 = *o.density_g_cm3;
  if (o.index_e) {
    LG_ASSIGN(medium, MakeMediumFromE(fmt::format("n_e = {}", *o.index_e), *o.index_e, medium.abbe,
                                      medium.density_g_cm3));
  } else if (o.index && *o.index != medium.index_d) {
    medium.name = fmt::format("n = {}", *o.index);
    medium.index_d = *o.index;
  }
  return entry;
}

void AddMakingOptions(CLI::App& command, LensOptions& o) {
  command.add_option("--medium", o.medium,
                     "Material: CR-39, crown, Trivex, polycarbonate, 1.60, 1.67, 1.74 (CR-39; or "
                     "the one nearest to the index that is given)");
  command.add_option("--index", o.index, "Refractive index at the d line, for the material's");
  command.add_option("--index-e", o.index_e, "... at the e line");
  command.add_option("--abbe", o.abbe, "Abbe number V_d, for the material's");
  command.add_option("--density", o.density_g_cm3, "Density, g/cm3, for the material's");
  command.add_option("--base", o.base_D,
                     "Base curve: power of the front surface at the index, D (by rule if absent)");
  command.add_option("--base-rule", o.base_rule, "Rule for the base curve")
      ->check(CLI::IsMember({"vogel", "chart", "tscherning"}))
      ->capture_default_str();
  command.add_option("--chart", o.chart, "Base curve chart for --base-rule chart (JSON; ours)");
  command
      .add_option("--power", o.power,
                  "How the back curve follows: exact, or the paper's equation (1)")
      ->check(CLI::IsMember({"exact", "paper"}))
      ->capture_default_str();
  command.add_option("--aspheric", o.aspheric_gaze_deg,
                     "Aspheric front, free of oblique astigmatism at this eye rotation, degrees");
  command.add_option("--toric", o.toric, "Side of the torus")
      ->check(CLI::IsMember({"back", "front"}))
      ->capture_default_str();
  command
      .add_option("--generator", o.generator,
                  "Circle that generates the torus: across or along the minus-cylinder axis")
      ->check(CLI::IsMember({"across", "along"}))
      ->capture_default_str();
  command.add_option("--center-thickness", o.center_thickness_mm,
                     "Centre thickness, mm (by rule if absent)");
  command.add_option("--min-center", o.min_center_mm, "Least centre thickness, mm (the medium's)");
  command.add_option("--min-edge", o.min_edge_mm, "Least edge thickness, mm (the medium's)");
  command.add_option("--diameter", o.diameter_mm, "Diameter of the round lens, mm")
      ->capture_default_str();
  command
      .add_option("--multifocal", o.multifocal,
                  "Front for an addition: a bifocal segment, or a progressive")
      ->check(CLI::IsMember({"none", "round", "flat-top", "executive", "progressive", "soft"}))
      ->capture_default_str();
  command.add_option("--segment-width", o.segment_width_mm, "Width of the segment, mm (22, or 28)");
  command
      .add_option("--segment-top", o.segment_top_mm,
                  "Height of the segment's top over the optical centre, mm (negative)")
      ->capture_default_str();
  command.add_option("--segment-inset", o.segment_inset_mm, "Of the segment, toward the nose, mm")
      ->capture_default_str();
  command.add_option("--corridor", o.corridor_mm, "Length of the progressive corridor, mm")
      ->capture_default_str();
  command
      .add_option("--corridor-start", o.corridor_start_mm,
                  "Height of its top over the optical centre, mm (0 or negative)")
      ->capture_default_str();
  command.add_option("--near-inset", o.near_inset_mm, "Of the near point, toward the nose, mm")
      ->capture_default_str();
  command.add_flag("--thinning", o.thinning,
                   "Prism thinning of a progressive: two thirds of the addition, base down");
  command.add_option("--prism-by", o.prism_by, "How prism is made")
      ->check(CLI::IsMember({"grinding", "decentration"}))
      ->capture_default_str();
  command
      .add_option("--max-decentration", o.max_decentration_mm,
                  "Prism that would need more than this is ground, mm")
      ->capture_default_str();
  command.add_option("--vertex", o.vertex_distance_mm,
                     "Back vertex to cornea as worn, mm (that of the refraction, else 13)");
  command.add_option(
      "--refraction-vertex", o.refraction_vertex_mm,
      "... at which the power was found: the lens is compensated for the difference");
  command
      .add_option("--pantoscopic", o.pantoscopic_deg,
                  "Pantoscopic tilt as worn, degrees: the lens is compensated for it")
      ->capture_default_str();
  command
      .add_option("--face-form", o.face_form_deg,
                  "Face form of each lens as worn, degrees: the lens is compensated for it")
      ->capture_default_str();
  command.add_option("--coat", o.coat, "Anti-reflection coat on both surfaces")
      ->check(CLI::IsMember({"none", "single", "v", "broadband"}))
      ->capture_default_str();
  command.add_option("--tint", o.tint,
                     "Grey tint: luminous transmittance of the glass at the centre, 0.01..1");
  command.add_option("--tint-kind", o.tint_kind, "In the surfaces, or through the glass")
      ->check(CLI::IsMember({"dip", "solid"}))
      ->capture_default_str();
}

void AddPowerOptions(CLI::App& command, LensOptions& o) {
  command.add_option("--sphere", o.sphere_D, "Sphere, D: exact back vertex power");
  command.add_option("--cylinder", o.cylinder_D, "Cylinder, D, either sign");
  command.add_option("--axis", o.axis_deg, "Axis of the cylinder, degrees (TABO)");
  command.add_option("--prism-in", o.prism_in, "Prism, base in (out: negative), prism D");
  command.add_option("--prism-up", o.prism_up, "Prism, base up (down: negative), prism D");
  command.add_option("--add", o.add_D, "Near addition, D, for --multifocal");
  command.add_option("--eye", o.eye, "Eye (for the sense of base in)")
      ->check(CLI::IsMember({"right", "left"}))
      ->capture_default_str();
}

void AddSurfaceOptions(CLI::App& command, LensOptions& o) {
  command
      .add_option("--front-radius", o.front_radii_mm,
                  "A lens by its surfaces: radius of the front, mm; positive when the centre "
                  "lies on the eye's side; inf for plano; two for a torus: along --axis, across it")
      ->delimiter(',')
      ->expected(1, 2);
  command.add_option("--back-radius", o.back_radii_mm, "Radius of the back, mm, in the same way")
      ->delimiter(',')
      ->expected(1, 2);
  command.add_option("--lens", o.lens_file,
                     "A lens file (JSON): any two surfaces, measured ones (SDF) among them");
}

}  // namespace lorgnette
