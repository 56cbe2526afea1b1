// SPDX-License-Identifier: Apache-2.0
// lorgnette measure: one lens, by its order or by its surfaces, and what is exactly true of it.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <nlohmann/json.hpp>
#include <ostream>

#include "apps/commands.h"
#include "apps/lens_json.h"
#include "apps/lens_options.h"
#include "optics/gaze.h"

namespace lorgnette {
namespace {

struct MeasureOptions {
  LensOptions lens;
  std::optional<double> camera_mm, depth_mm, height_mm;
  std::vector<double> gaze_deg;  // theta, phi
  double stop_mm = 27;
};

Status CheckPositive(const char* name, double value) {
  if (value > 0 && std::isfinite(value)) return {};
  return UsageError(fmt::format("{}: got {}, want more than 0 mm", name, value));
}

constexpr double kMaxTheta_deg = 60, kMaxPhi_deg = 360;

// What the rotating eye meets, the object at infinity.
Status AddGaze(const MeasureOptions& options, const Lens& lens, nlohmann::ordered_json& json) {
  if (options.gaze_deg.size() != 2) return UsageError("--gaze: want THETA,PHI in degrees");
  const double theta = options.gaze_deg[0], phi = options.gaze_deg[1];
  if (!(std::abs(theta) <= kMaxTheta_deg && std::abs(phi) <= kMaxPhi_deg)) {
    return UsageError(fmt::format("--gaze: got {},{}, want at most {},{} degrees", theta, phi,
                                  kMaxTheta_deg, kMaxPhi_deg));
  }
  LG_RETURN_IF_ERROR(CheckPositive("--stop", options.stop_mm));
  const GazeVergence gaze =
      EvaluateGaze(lens, lens.medium.index_d, EyePose::OnAxis(lens, options.stop_mm),
                   {RadiansFromDegrees(theta), RadiansFromDegrees(phi)});
  if (gaze.status != RayStatus::kOk) {
    return Failure(fmt::format("--gaze: no ray passes the lens at {},{} degrees", theta, phi));
  }
  json["gaze_deg"] = options.gaze_deg;
  json["stop_mm"] = options.stop_mm;
  json["sagittal_D"] = gaze.sagittal_D;
  json["tangential_D"] = gaze.tangential_D;
  json["sphere_D"] = gaze.power.sphere.value();
  json["cylinder_D"] = gaze.power.cylinder.value();
  json["axis_deg"] = gaze.power.axis.value();
  return {};
}

Status Measure(const MeasureOptions& options, std::ostream& out) {
  LG_ASSIGN(const LensDesign design, LensFromOptions(options.lens));
  SheetRequest request;
  request.feature_meridian_deg =
      design.order.rx.cylinder.value() != 0 ? design.order.rx.axis.value() : 180;
  if (options.camera_mm) {
    LG_RETURN_IF_ERROR(CheckPositive("--camera", *options.camera_mm));
    request.observer.camera_mm = *options.camera_mm;
  }
  if (options.depth_mm) {
    LG_RETURN_IF_ERROR(CheckPositive("--depth", *options.depth_mm));
    request.observer.depth_mm = *options.depth_mm;
  }
  if (options.height_mm) request.feature_height_mm = *options.height_mm;
  const LensSheet sheet = MakeLensSheet(design, request);
  nlohmann::ordered_json json = LensJson(design, sheet);
  if (options.camera_mm || options.depth_mm || options.height_mm) {
    json["camera_mm"] = request.observer.camera_mm;
    json["depth_mm"] = request.observer.depth_mm;
    json["height_mm"] = request.feature_height_mm;
    json["observer_magnification_thin"] = sheet.observer_magnification_thin;
    json["observer_magnification_paraxial"] = sheet.observer_magnification_paraxial;
    json["observer_magnification_exact"] = nullptr;
    if (sheet.observer_magnification_exact) {
      json["observer_magnification_exact"] = *sheet.observer_magnification_exact;
    }
  }
  if (options.depth_mm) {
    // The wearer's own, with the entrance pupil at this depth.
    const double n = design.lens.medium.index_d, t = design.lens.center_thickness_mm;
    const auto magnification = [&](double front, double back) {
      return SpectacleMagnification(
          ParaxialSystem::ThickLens(Diopters(front), Diopters(back), t, n), *options.depth_mm);
    };
    json["spectacle_magnification"] =
        magnification(sheet.front_power_D.along, sheet.back_power_D.along);
    json["meridians"]["spectacle_magnification"] = {
        magnification(sheet.front_power_D.along, sheet.back_power_D.along),
        magnification(sheet.front_power_D.across, sheet.back_power_D.across)};
    json["pupil_mm"] = *options.depth_mm;
  } else {
    json["pupil_mm"] = sheet.pupil_mm;
  }
  if (!options.gaze_deg.empty()) LG_RETURN_IF_ERROR(AddGaze(options, design.lens, json));
  out << json.dump(2) << '\n';
  return {};
}

}  // namespace

void AddMeasureCommand(CLI::App& program, CommandContext& context) {
  CLI::App& command =
      *program.add_subcommand("measure", "Measure one lens, by its order or by its surfaces; JSON");
  const auto options = std::make_shared<MeasureOptions>();
  AddPowerOptions(command, options->lens);
  AddSurfaceOptions(command, options->lens);
  AddMakingOptions(command, options->lens);
  command.add_option("--camera", options->camera_mm,
                     "A camera on the axis, this many mm before the front vertex");
  command.add_option("--depth", options->depth_mm,
                     "What it sees lies this many mm behind the back vertex; the wearer's entrance "
                     "pupil is put there too");
  command.add_option("--height", options->height_mm, "... and this many mm off the axis");
  command
      .add_option("--gaze", options->gaze_deg,
                  "Vergence for an eye turned by THETA degrees from the axis, in the direction PHI "
                  "from the wearer's right toward up; object at infinity")
      ->delimiter(',')
      ->expected(2);
  command
      .add_option("--stop", options->stop_mm, "The eye turns this many mm behind the back vertex")
      ->capture_default_str();
  command.footer(
      "Examples:\n"
      "  lorgnette measure --sphere -6 --index 1.498 --base 3 --center-thickness 2\n"
      "  lorgnette measure --front-radius 91.21 --back-radius 60,52 --axis 90 --center-thickness "
      "2\n"
      "  lorgnette measure --sphere -6 --camera 500 --depth 15 --height 5.85\n"
      "  lorgnette measure --sphere -6 --gaze 30,0 --stop 27");
  command.final_callback([options, &context] { context.status = Measure(*options, context.out); });
}

}  // namespace lorgnette
