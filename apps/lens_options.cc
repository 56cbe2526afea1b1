// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_options.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cmath>

#include "base/atomic_file.h"
#include "geometry/frame_io.h"
#include "optics/base_curve.h"
#include "optics/media.h"
#include "optics/outline.h"
#include "optics/paraxial.h"

namespace lorgnette {
namespace {

Status CheckRange(const char* option, double value, double min, double max) {
  if (value >= min && value <= max) return {};
  return UsageError(fmt::format("{}: got {}, want {}..{}", option, value, min, max));
}

constexpr double kMinIndex = 1.3, kMaxIndex = 2.2;
constexpr double kMinThickness_mm = 0.1, kMaxThickness_mm = 40;
constexpr double kMinRadius_mm = 5;
constexpr double kMinDiameter_mm = 5, kMaxDiameter_mm = 120;
constexpr double kMaxBase_D = 25;

Status CheckMaking(const LensOptions& o) {
  if (o.aspheric_gaze_deg) {
    LG_RETURN_IF_ERROR(CheckRange("--aspheric", *o.aspheric_gaze_deg, 5, 45));
  }
  LG_RETURN_IF_ERROR(CheckRange("--diameter", o.diameter_mm, kMinDiameter_mm, kMaxDiameter_mm));
  LG_RETURN_IF_ERROR(CheckRange("--vertex", o.vertex_distance_mm, kMinVertex_mm, kMaxVertex_mm));
  if (o.base_D) LG_RETURN_IF_ERROR(CheckRange("--base", *o.base_D, -kMaxBase_D, kMaxBase_D));
  if (o.center_thickness_mm) {
    LG_RETURN_IF_ERROR(CheckRange("--center-thickness", *o.center_thickness_mm, kMinThickness_mm,
                                  kMaxThickness_mm));
  }
  return {};
}

Status CheckPower(const LensOptions& o) {
  LG_RETURN_IF_ERROR(CheckRange("--sphere", *o.sphere_D, -kMaxSphere, kMaxSphere));
  LG_RETURN_IF_ERROR(CheckRange("--cylinder", o.cylinder_D, -kMaxCylinder, kMaxCylinder));
  LG_RETURN_IF_ERROR(CheckRange("--prism-in", o.prism_in, -kMaxPrism, kMaxPrism));
  LG_RETURN_IF_ERROR(CheckRange("--prism-up", o.prism_up, -kMaxPrism, kMaxPrism));
  if (o.axis_deg) LG_RETURN_IF_ERROR(CheckRange("--axis", *o.axis_deg, 0, 180));
  if (o.cylinder_D != 0 && !o.axis_deg) {
    return UsageError("--cylinder: got a cylinder without --axis, want both");
  }
  if (o.cylinder_D == 0 && o.axis_deg) {
    return UsageError("--axis: got an axis without --cylinder, want both or neither");
  }
  return {};
}

Status SetMaking(const LensOptions& options, LensOrder& order) {
  order.eye = options.eye == "left" ? Eye::kLeft : Eye::kRight;
  LG_ASSIGN(order.medium, MediumFromOptions(options.medium, options.index, options.density_g_cm3));
  if (options.base_D) order.base_curve = Diopters(*options.base_D);
  order.center_thickness_mm = options.center_thickness_mm;
  order.diameter_mm = options.diameter_mm;
  order.vertex_distance_mm = options.vertex_distance_mm;
  order.generator = options.generator == "along" ? ToricGenerator::kAlongMinusAxis
                                                 : ToricGenerator::kAcrossMinusAxis;
  order.toric_side = options.toric == "front" ? ToricSide::kFront : ToricSide::kBack;
  order.base_rule =
      options.base_rule == "tscherning" ? BaseCurveRule::kTscherning : BaseCurveRule::kVogel;
  order.aspheric_gaze_deg = options.aspheric_gaze_deg;
  return {};
}

// The chart's base curve, when it is asked for and no other is given. Needs order.rx and medium.
Status ApplyChart(const LensOptions& options, LensOrder& order) {
  if (options.base_rule != "chart" || order.base_curve) return {};
  const std::string path =
      options.chart.empty() ? DataDirectory() + "/base_curves.json" : options.chart;
  LG_ASSIGN(const std::string text, ReadFile(path));
  LG_ASSIGN(const BaseCurveChart chart, ParseBaseCurveChart(text, path));
  const Diopters equivalent = order.rx.sphere + 0.5 * order.rx.cylinder;
  LG_ASSIGN(order.base_curve, chart.Choose(order.medium.name, order.medium.index_d, equivalent));
  return {};
}

double CurvatureOf(double radius_mm) { return std::isinf(radius_mm) ? 0 : 1 / radius_mm; }

// The back surface of the given curvatures along and across the axis.
Surface BackFromRadii(double along, double across, AxisDegrees axis, ToricGenerator generator) {
  if (along == across) return SphereSurface{along};
  // The minus axis is the meridian of the less negative power, the smaller back curvature.
  const bool along_generates = (along < across) == (generator == ToricGenerator::kAlongMinusAxis);
  // A TABO meridian A points along (-cos A, sin A) in the lens frame: at 180 - A from +x.
  const double along_angle = kPi - axis.radians();
  if (along_generates) return TorusSurface{along, across, along_angle};
  return TorusSurface{across, along, along_angle + kPi / 2};
}

Result<LensDesign> LensFromSurfaces(const LensOptions& o) {
  LG_RETURN_IF_ERROR(CheckMaking(o));
  if (o.sphere_D) {
    return UsageError("--front-radius: got it together with --sphere, want one of the two");
  }
  if (o.back_radii_mm.empty() || o.back_radii_mm.size() > 2) {
    return UsageError("--back-radius: want one radius, or two (along the axis, across it)");
  }
  if (!o.center_thickness_mm) {
    return UsageError("--center-thickness: missing, a lens given by its surfaces needs it");
  }
  std::vector<double> radii = o.back_radii_mm;
  radii.push_back(*o.front_radius_mm);
  for (const double radius : radii) {
    if (!(std::abs(radius) >= kMinRadius_mm)) {
      return UsageError(
          fmt::format("--front-radius, --back-radius: got {}, want at least {} mm "
                      "(either sign), or inf",
                      radius, kMinRadius_mm));
    }
  }
  const double along = CurvatureOf(radii[0]);
  const double across = o.back_radii_mm.size() == 2 ? CurvatureOf(radii[1]) : along;
  if (along != across && !o.axis_deg) {
    return UsageError("--back-radius: got two radii without --axis, want both");
  }
  LensDesign design;
  LensOrder& order = design.order;
  LG_RETURN_IF_ERROR(SetMaking(o, order));
  const double n = order.medium.index_d;
  design.lens.medium = order.medium;
  design.lens.center_thickness_mm = *o.center_thickness_mm;
  design.lens.front = SphereSurface{CurvatureOf(*o.front_radius_mm)};
  const AxisDegrees axis(o.axis_deg.value_or(180));
  design.lens.back = BackFromRadii(along, across, axis, order.generator);
  design.front_power = Diopters::FromPerMm((n - 1) * CurvatureOf(*o.front_radius_mm));
  design.back_power_axis = Diopters::FromPerMm((1 - n) * along);
  design.back_power_across = Diopters::FromPerMm((1 - n) * across);
  // What this lens is, as an order.
  const auto power = [&](Diopters back) {
    return ParaxialSystem::ThickLens(design.front_power, back, *o.center_thickness_mm, n)
        .BackVertexPower();
  };
  order.rx.sphere = power(design.back_power_axis);
  order.rx.cylinder = power(design.back_power_across) - order.rx.sphere;
  order.rx.axis = axis;
  order.base_curve = design.front_power;

  const Outline outline = Outline::Round(o.diameter_mm);
  const std::optional<EdgeThickness> edge = EdgeOver(design.lens, outline);
  if (!edge) {
    return Failure(
        fmt::format("lens: a surface has no real sag over a diameter of {} mm", o.diameter_mm));
  }
  if (edge->least_inside_mm < 0) {
    return Failure(
        fmt::format("lens: the surfaces cross inside a diameter of {} mm; possible: a "
                    "thicker or a smaller lens",
                    o.diameter_mm));
  }
  design.min_edge_thickness_mm = edge->least_mm;
  design.max_edge_thickness_mm = edge->greatest_mm;
  design.mass_g = MassOver(design.lens, outline);
  return design;
}

}  // namespace

Result<Medium> MediumFromOptions(const std::string& name, std::optional<double> index,
                                 std::optional<double> density_g_cm3) {
  LG_ASSIGN(const MediumEntry entry, FindMedium(name));
  Medium medium = entry.medium;
  if (index) {
    LG_RETURN_IF_ERROR(CheckRange("--index", *index, kMinIndex, kMaxIndex));
    if (*index != medium.index_d) medium.name = fmt::format("n = {}", *index);
    medium.index_d = *index;
  }
  if (density_g_cm3) {
    LG_RETURN_IF_ERROR(CheckRange("--density", *density_g_cm3, 0.5, 8));
    medium.density_g_cm3 = *density_g_cm3;
  }
  return medium;
}

void AddMakingOptions(CLI::App& command, LensOptions& o) {
  command
      .add_option("--medium", o.medium,
                  "Material: CR-39, crown, Trivex, polycarbonate, 1.60, 1.67, 1.74")
      ->capture_default_str();
  command.add_option("--index", o.index, "Refractive index at the d line, for the material's");
  command.add_option("--density", o.density_g_cm3, "Density, g/cm3, for the material's");
  command.add_option("--base", o.base_D,
                     "Base curve: power of the front surface at the index, D (by rule if absent)");
  command.add_option("--base-rule", o.base_rule, "Rule for the base curve")
      ->check(CLI::IsMember({"vogel", "chart", "tscherning"}))
      ->capture_default_str();
  command.add_option("--chart", o.chart, "Base curve chart for --base-rule chart (JSON; ours)");
  command.add_option("--aspheric", o.aspheric_gaze_deg,
                     "Aspheric front, free of oblique astigmatism at this eye rotation, degrees");
  command.add_option("--toric", o.toric, "Side of the torus")
      ->check(CLI::IsMember({"back", "front"}))
      ->capture_default_str();
  command.add_option("--center-thickness", o.center_thickness_mm,
                     "Centre thickness, mm (by rule if absent)");
  command.add_option("--diameter", o.diameter_mm, "Diameter of the round lens, mm")
      ->capture_default_str();
  command.add_option("--vertex", o.vertex_distance_mm, "Back vertex to cornea, mm")
      ->capture_default_str();
  command
      .add_option("--generator", o.generator,
                  "Circle that generates the torus: across or along the minus-cylinder axis")
      ->check(CLI::IsMember({"across", "along"}))
      ->capture_default_str();
}

void AddPowerOptions(CLI::App& command, LensOptions& o) {
  command.add_option("--sphere", o.sphere_D, "Sphere, D: exact back vertex power");
  command.add_option("--cylinder", o.cylinder_D, "Cylinder, D, either sign");
  command.add_option("--axis", o.axis_deg, "Axis of the cylinder, degrees (TABO)");
  command.add_option("--prism-in", o.prism_in, "Prism, base in (out: negative), prism D");
  command.add_option("--prism-up", o.prism_up, "Prism, base up (down: negative), prism D");
  command.add_option("--eye", o.eye, "Eye (for the sense of base in)")
      ->check(CLI::IsMember({"right", "left"}))
      ->capture_default_str();
}

void AddSurfaceOptions(CLI::App& command, LensOptions& o) {
  command.add_option("--front-radius", o.front_radius_mm,
                     "A lens by its surfaces: radius of the front, mm; positive when the centre "
                     "lies on the eye's side; inf for plano");
  command
      .add_option("--back-radius", o.back_radii_mm,
                  "Radius of the back, mm; two for a torus: along --axis, and across it")
      ->delimiter(',')
      ->expected(1, 2);
}

Result<LensOrder> OrderFromOptions(const LensOptions& options) {
  if (!options.sphere_D) return UsageError("--sphere: missing, want the sphere in dioptres");
  LG_RETURN_IF_ERROR(CheckMaking(options));
  LG_RETURN_IF_ERROR(CheckPower(options));
  EyePrescription rx;
  rx.sphere = Diopters(*options.sphere_D);
  rx.cylinder = Diopters(options.cylinder_D);
  if (options.axis_deg) rx.axis = AxisDegrees(*options.axis_deg);
  rx.prism_in = PrismDiopters(options.prism_in);
  rx.prism_up = PrismDiopters(options.prism_up);
  LensOrder order;
  LG_RETURN_IF_ERROR(SetMaking(options, order));
  order.rx = rx;
  LG_RETURN_IF_ERROR(ApplyChart(options, order));
  return order;
}

Result<LensOrder> OrderFromPrescription(const EyePrescription& rx, Eye eye,
                                        const LensOptions& options) {
  LG_RETURN_IF_ERROR(CheckMaking(options));
  LensOrder order;
  LG_RETURN_IF_ERROR(SetMaking(options, order));
  order.eye = eye;
  order.rx = rx;
  LG_RETURN_IF_ERROR(ApplyChart(options, order));
  return order;
}

Result<LensDesign> LensFromOptions(const LensOptions& options) {
  if (options.front_radius_mm) return LensFromSurfaces(options);
  LG_ASSIGN(const LensOrder order, OrderFromOptions(options));
  return DesignLens(order);
}

}  // namespace lorgnette
