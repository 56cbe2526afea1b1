// SPDX-License-Identifier: Apache-2.0
// lorgnette cost: what accuracy costs in time, on a lens and a scene of choice.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <ostream>
#include <string>

#include "apps/commands.h"
#include "apps/lens_options.h"
#include "apps/lens_orders.h"
#include "base/atomic_file.h"
#include "validation/cost/studies.h"

namespace lorgnette {
namespace {

namespace vc = validation;

constexpr double kDefaultSphere_D = -6;

struct CostCommandOptions {
  LensOptions lens;
  vc::CostOptions cost;
  std::string max_error, max_time, csv, html, svg;
  bool json = false;
};

Status CheckAtLeast(const char* name, double value, double least, double most) {
  if (value >= least && value <= most) return {};
  return UsageError(fmt::format("{}: got {}, want {}..{}", name, value, least, most));
}

Status RunCostCommand(CostCommandOptions options, std::ostream& out) {
  const vc::LensView& view = options.cost.view;
  LG_RETURN_IF_ERROR(CheckAtLeast("--camera", view.camera_mm, 50, 5000));
  LG_RETURN_IF_ERROR(CheckAtLeast("--depth", view.face_mm, 1, 200));
  LG_RETURN_IF_ERROR(CheckAtLeast("--focal", view.focal_px, 100, 20000));
  LG_RETURN_IF_ERROR(CheckAtLeast("--width", view.width_mm, 10, 80));
  LG_RETURN_IF_ERROR(CheckAtLeast("--height", view.height_mm, 10, 80));
  LG_ASSIGN(const vc::CostBudget budget, vc::ParseBudget(options.max_error, options.max_time));
  const bool has_budget = budget.max_error || budget.max_ms;
  if (!options.lens.sphere_D) options.lens.sphere_D = kDefaultSphere_D;
  LG_ASSIGN(const MadeLens lens, LensFromOptions(options.lens));
  LG_ASSIGN(const vc::CostReport report, vc::RunCost(lens.design, options.cost));
  out << (options.json ? vc::CostJson(report)
                       : vc::CostText(report, has_budget ? &budget : nullptr));
  if (!options.csv.empty()) {
    LG_RETURN_IF_ERROR(WriteFileAtomically(options.csv, vc::CostCsv(report)));
  }
  if (!options.html.empty()) {
    LG_RETURN_IF_ERROR(
        WriteFileAtomically(options.html, vc::CostHtml(report, has_budget ? &budget : nullptr)));
  }
  if (!options.svg.empty()) {
    for (const vc::CostStudy& study : report.studies) {
      for (std::size_t unit = 0; unit < study.units.size(); ++unit) {
        const std::string path =
            fmt::format("{}-{}-{}.svg", options.svg, study.name, study.units[unit].name);
        LG_RETURN_IF_ERROR(WriteFileAtomically(path, vc::CostPlotSvg(study, unit, true)));
      }
    }
  }
  return {};
}

}  // namespace

void AddCostCommand(CLI::App& program, CommandContext& context) {
  CLI::App& command = *program.add_subcommand(
      "cost", "What accuracy costs in time: errors and times of each way of computing");
  const auto options = std::make_shared<CostCommandOptions>();
  AddPowerOptions(command, options->lens);
  AddMakingOptions(command, options->lens);
  vc::LensView& view = options->cost.view;
  command.add_option("--study", options->cost.studies, "Only these studies")
      ->delimiter(',')
      ->check(CLI::IsMember(vc::StudyNames()));
  command.add_option("--camera", view.camera_mm, "Camera before the front vertex, mm")
      ->capture_default_str();
  command.add_option("--depth", view.face_mm, "Face behind the back vertex, mm")
      ->capture_default_str();
  command.add_option("--focal", view.focal_px, "Focal length of the camera, pixels")
      ->capture_default_str();
  command.add_option("--width", view.width_mm, "Width of the lens in the picture, mm")
      ->capture_default_str();
  command.add_option("--height", view.height_mm, "Height of the lens in the picture, mm")
      ->capture_default_str();
  command
      .add_option("--frame", options->cost.frame,
                  "Frame of the scene that is made for shading and picture")
      ->capture_default_str();
  command.add_option("--scene", options->cost.scene_case,
                     "A scene file of `lorgnette compose` in its place, with its own lenses");
  command.add_option("--max-error", options->max_error,
                     "Recommend within this error: 0.1px, 0.5%, 0.01D, 1arcmin, 0.02ratio, "
                     "1levels");
  command.add_option("--max-time", options->max_time,
                     "Recommend within this time a frame: 10ms, 500us");
  command.add_flag("--json", options->json, "Print the study as JSON");
  command.add_option("--csv", options->csv, "Also write a table");
  command.add_option("--svg", options->svg, "Also write plots, NAME-STUDY-UNIT.svg");
  command.add_option("--html", options->html, "Also write a page that needs no network");
  command.footer(
      "Examples:\n"
      "  lorgnette cost --sphere -6 --index 1.6 --max-error 0.1px --max-time 10ms\n"
      "  lorgnette cost --study lens --sphere 4 --cylinder -2 --axis 30 --html cost.html\n"
      "Times are medians over repetitions in one process; a quiet machine gives steady ones. "
      "docs/cost.md explains every method and unit.");
  command.final_callback(
      [options, &context] { context.status = RunCostCommand(*options, context.out); });
}

}  // namespace lorgnette
