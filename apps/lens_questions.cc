// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_questions.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/lens_json.h"
#include "optics/focimeter.h"
#include "optics/fresnel.h"
#include "optics/gaze.h"
#include "optics/power_map.h"
#include "optics/prism.h"
#include "optics/tint.h"

namespace lorgnette {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMaxTheta_deg = 60, kMaxPhi_deg = 360;
constexpr double kFarthest_mm = 1e9;

Status CheckPositive(const char* name, double value) {
  if (value > 0 && value <= kFarthest_mm) return {};
  return UsageError(
      fmt::format("{}: got {}, want more than 0 and at most {:g} mm", name, value, kFarthest_mm));
}

Json FormJson(const SphereCylinder& power) {
  return {{"sphere_D", power.sphere.value()},
          {"cylinder_D", power.cylinder.value()},
          {"axis_deg", power.axis.value()}};
}

// What the rotating eye meets, the object at infinity.
Status AddGaze(const LensQuestions& q, const Lens& lens, Json& json) {
  const double theta = q.gaze_deg[0], phi = q.gaze_deg[1];
  if (!(std::abs(theta) <= kMaxTheta_deg && std::abs(phi) <= kMaxPhi_deg)) {
    return UsageError(fmt::format("--gaze: got {},{}, want at most {},{} degrees", theta, phi,
                                  kMaxTheta_deg, kMaxPhi_deg));
  }
  const GazeVergence gaze =
      EvaluateGaze(lens, lens.medium.index_d, EyePose::OnAxis(lens, q.stop_mm),
                   {RadiansFromDegrees(theta), RadiansFromDegrees(phi)});
  if (gaze.status != RayStatus::kOk) {
    return Failure(
        fmt::format("--gaze: no ray passes the lens at {},{} degrees; possible: a "
                    "smaller angle",
                    theta, phi));
  }
  json["gaze_deg"] = q.gaze_deg;
  json["stop_mm"] = q.stop_mm;
  json["sagittal_D"] = gaze.sagittal_D;
  json["tangential_D"] = gaze.tangential_D;
  json.update(FormJson(gaze.power));
  return {};
}

Status AddFocimeter(const LensQuestions& q, const Lens& lens, Json& json) {
  LG_RETURN_IF_ERROR(CheckRange("--aperture", q.aperture_mm, 0.001, 10));
  const Eigen::Vector2d at(q.focimeter_mm[0], q.focimeter_mm[1]);
  for (const double x : {at.x(), at.y()}) LG_RETURN_IF_ERROR(CheckRange("--focimeter", x, -60, 60));
  FocimeterOptions options;
  options.pupil_radius_mm = q.aperture_mm;
  const auto back = ReadBackVertexPower(lens, lens.medium.index_d, at, options);
  const auto front = ReadFrontVertexPower(lens, lens.medium.index_d, at, options);
  if (!back || !front) {
    return Failure(fmt::format("--focimeter: no ray passes the lens at {}, {} mm", at.x(), at.y()));
  }
  const auto reading = [](const FocimeterReading& r) {
    Json one = FormJson(r.power);
    one["prism"] = {r.prism.x(), r.prism.y()};
    one["residual_D"] = r.residual_D;
    return one;
  };
  json["focimeter"] = {{"at_mm", {at.x(), at.y()}},
                       {"aperture_mm", q.aperture_mm},
                       {"back", reading(*back)},
                       {"front", reading(*front)}};
  return {};
}

Status AddMap(const LensQuestions& q, const Lens& lens, Json& json) {
  LG_RETURN_IF_ERROR(CheckRange("--map", *q.map_deg, 1, 50));
  PowerMapOptions options;
  options.half_angle_deg = *q.map_deg;
  options.stop_mm = q.stop_mm;
  const MapSummary summary = Summarize(MakePowerMap(lens, lens.medium.index_d, options));
  if (summary.points == 0) return Failure("--map: no ray passes the lens");
  const auto range = [](const MapRange& r) { return Json{r.least, r.greatest}; };
  json["map"] = {{"half_angle_deg", *q.map_deg},
                 {"points", summary.points},
                 {"mean_power_D", range(summary.mean_power_D)},
                 {"cylinder_D", range(summary.cylinder_D)},
                 {"prism", range(summary.prism)},
                 {"distortion", range(summary.distortion)},
                 {"lateral_colour", range(summary.lateral_colour)}};
  return {};
}

// The wearer's own, with the entrance pupil at the depth asked about.
void PutPupilAt(double depth_mm, const LensDesign& design, const LensSheet& sheet, Json& json) {
  const auto at = [&](double front, double back) {
    return JsonNumber(SpectacleMagnification(
        ParaxialSystem::ThickLens(Diopters(front), Diopters(back), sheet.center_thickness_mm,
                                  design.lens.medium.index_d),
        depth_mm));
  };
  const Json along = at(sheet.front_power_D.along, sheet.back_power_D.along);
  json["spectacle_magnification"] = along;
  json["meridians"]["spectacle_magnification"] = {
      along, at(sheet.front_power_D.across, sheet.back_power_D.across)};
}

void AddWear(const MadeLens& made, Json& json) {
  const WearCompensation& w = *made.wear;
  const auto vector = [](const PowerVector& p) { return FormJson(MinusCylinderForm(p)); };
  const auto worn = [&](const WornPower& p) {
    Json one = vector(p.power);
    one["prism_in"] = p.prism_in;
    one["prism_up"] = p.prism_up;
    return one;
  };
  json["wear"] = {{"pantoscopic_deg", made.worn_as->pantoscopic_deg},
                  {"face_form_deg", made.worn_as->face_form_deg},
                  {"vertex_distance_mm", made.worn_as->vertex_distance_mm},
                  {"refraction_vertex_mm", made.refraction_vertex_mm},
                  {"target", vector(w.target)},
                  {"worn", worn(w.worn)},
                  {"worn_without_compensation", worn(w.untouched)}};
}

Status AddPrism(const MadeLens& made, Json& json) {
  const PrismDesign& p = *made.prism;
  const Lens& lens = made.design.lens;
  const Eigen::Vector2d& at = p.reference_point_mm;
  const auto prism = PrismAt(lens, lens.medium.index_d, at);
  if (!prism) return Failure("lens: no ray passes the reference point of its prism");
  json["prism"] = {{"by", p.decentred ? "decentration" : "grinding"},
                   {"reference_point_mm", {at.x(), at.y()}},
                   {"in", PrismIn(made.design.order.eye, *prism)},
                   {"up", prism->y()}};
  if (!p.why_ground.empty()) json["prism"]["why_ground"] = p.why_ground;
  return {};
}

CoatKind CoatOf(const std::string& name) {
  return name == "single"      ? CoatKind::kSingle
         : name == "v"         ? CoatKind::kVCoat
         : name == "broadband" ? CoatKind::kBroadband
                               : CoatKind::kNone;
}

}  // namespace

Result<LensLight> LightOf(const LensDesign& design, const LensOptions& o) {
  const Lens& lens = design.lens;
  const double n = lens.medium.index_d, t = lens.center_thickness_mm;
  LensFilter filter;
  filter.index = n;
  filter.front_coat = filter.back_coat = CoatOf(o.coat);
  if (o.tint) {
    LG_ASSIGN(filter.tint,
              GreyTint(o.tint_kind == "solid" ? TintKind::kSolid : TintKind::kDip, *o.tint, t));
  }
  LensLight light;
  light.luminous_transmittance = LuminousTransmittance(filter, 1, t);
  light.luminous_transmittance_edge =
      LuminousTransmittance(filter, 1, std::max(t, design.max_edge_thickness_mm));
  light.filter_category = FilterCategory(light.luminous_transmittance);
  const Spectrum residual = CoatReflectance(filter.front_coat, n, 1);
  light.reflectance = LuminousFraction(residual);
  const Eigen::Vector2d colour = ChromaticityUnderD65(residual);
  light.reflection_x = colour.x();
  light.reflection_y = colour.y();
  const Ghost ghost = GhostOf(lens, n, light.reflectance, light.reflectance);
  light.ghost_power_D = ghost.power.value();
  light.ghost_intensity = ghost.relative_intensity;
  return light;
}

Result<Json> AnsweredJson(const MadeLens& made, const LensOptions& options,
                          const LensQuestions& q) {
  const LensDesign& design = made.design;
  SheetRequest request;
  request.feature_meridian_deg =
      design.order.rx.cylinder.value() != 0 ? design.order.rx.axis.value() : 180;
  LG_RETURN_IF_ERROR(CheckPositive("--stop", q.stop_mm));
  if (q.camera_mm) {
    LG_RETURN_IF_ERROR(CheckPositive("--camera", *q.camera_mm));
    request.observer.camera_mm = *q.camera_mm;
  }
  if (q.depth_mm) {
    LG_RETURN_IF_ERROR(CheckPositive("--depth", *q.depth_mm));
    request.observer.depth_mm = *q.depth_mm;
  }
  if (q.height_mm) {
    LG_RETURN_IF_ERROR(CheckRange("--height", *q.height_mm, -100, 100));
    request.feature_height_mm = *q.height_mm;
  }
  const LensSheet sheet = MakeLensSheet(design, request);
  Json json = LensJson(design, sheet);
  if (made.thinning_down.value() != 0) json["thinning_prism_down"] = made.thinning_down.value();
  if (made.prism) LG_RETURN_IF_ERROR(AddPrism(made, json));
  if (made.wear) AddWear(made, json);
  if (q.camera_mm || q.depth_mm || q.height_mm) {
    json["camera_mm"] = request.observer.camera_mm;
    json["depth_mm"] = request.observer.depth_mm;
    json["height_mm"] = request.feature_height_mm;
    json["observer_magnification_thin"] = JsonNumber(sheet.observer_magnification_thin);
    json["observer_magnification_paraxial"] = JsonNumber(sheet.observer_magnification_paraxial);
    json["observer_magnification_exact"] =
        JsonNumber(sheet.observer_magnification_exact.value_or(HUGE_VAL));
  }
  if (q.depth_mm) PutPupilAt(*q.depth_mm, design, sheet, json);
  json["pupil_mm"] = q.depth_mm.value_or(sheet.pupil_mm);
  if (!q.gaze_deg.empty()) LG_RETURN_IF_ERROR(AddGaze(q, design.lens, json));
  if (!q.focimeter_mm.empty()) LG_RETURN_IF_ERROR(AddFocimeter(q, design.lens, json));
  if (q.map_deg) LG_RETURN_IF_ERROR(AddMap(q, design.lens, json));
  LG_ASSIGN(const LensLight light, LightOf(design, options));
  json["light"] = {
      {"coat", options.coat},
      {"luminous_transmittance", light.luminous_transmittance},
      {"luminous_transmittance_edge", light.luminous_transmittance_edge},
      {"filter_category", light.filter_category ? Json(*light.filter_category) : Json(nullptr)},
      {"reflectance", light.reflectance},
      {"reflection_chromaticity", {light.reflection_x, light.reflection_y}},
      {"ghost_power_D", JsonNumber(light.ghost_power_D)},
      {"ghost_intensity", light.ghost_intensity}};
  return json;
}

void AddQuestionOptions(CLI::App& command, LensQuestions& q) {
  command.add_option("--camera", q.camera_mm,
                     "A camera on the axis, this many mm before the front vertex");
  command.add_option("--depth", q.depth_mm,
                     "What it sees lies this many mm behind the back vertex; the wearer's entrance "
                     "pupil is put there too");
  command.add_option("--height", q.height_mm, "... and this many mm off the axis");
  command
      .add_option("--gaze", q.gaze_deg,
                  "Vergence for an eye turned by THETA degrees from the axis, in the direction PHI "
                  "from the wearer's right toward up; object at infinity")
      ->delimiter(',')
      ->expected(2);
  command.add_option("--stop", q.stop_mm, "The eye turns this many mm behind the back vertex")
      ->capture_default_str();
  command
      .add_option("--focimeter", q.focimeter_mm,
                  "Reading of a focimeter at X,Y mm of the back surface (front for the front "
                  "vertex power): +x to the wearer's right, +y up")
      ->delimiter(',')
      ->expected(2);
  command.add_option("--aperture", q.aperture_mm, "Radius of the focimeter's pupil, mm")
      ->capture_default_str();
  command.add_option("--map", q.map_deg,
                     "Ranges of power, cylinder, prism, distortion and lateral colour over the "
                     "field, up to this eye rotation, degrees");
}

}  // namespace lorgnette
