// SPDX-License-Identifier: Apache-2.0
// lorgnette measure: one lens, by its order or by its surfaces, and what is exactly true of it.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <nlohmann/json.hpp>
#include <ostream>

#include "apps/commands.h"
#include "apps/lens_orders.h"
#include "apps/lens_questions.h"

namespace lorgnette {
namespace {

struct MeasureOptions {
  LensOptions lens;
  LensQuestions questions;
};

Status Measure(const MeasureOptions& options, std::ostream& out) {
  LG_ASSIGN(const MadeLens lens, LensFromOptions(options.lens));
  LG_ASSIGN(const nlohmann::ordered_json json, AnsweredJson(lens, options.lens, options.questions));
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
  AddQuestionOptions(command, options->questions);
  AddMakingOptions(command, options->lens);
  command.footer(
      "Examples:\n"
      "  lorgnette measure --sphere -6 --index 1.498 --base 3 --center-thickness 2\n"
      "  lorgnette measure --front-radius 91.21 --back-radius 60,52 --axis 90 --center-thickness "
      "2\n"
      "  lorgnette measure --sphere -6 --camera 500 --depth 15 --height 5.85\n"
      "  lorgnette measure --sphere -6 --gaze 30,0 --stop 27\n"
      "  lorgnette measure --lens lens.json --focimeter 0,-14 --aperture 2.5");
  command.final_callback([options, &context] { context.status = Measure(*options, context.out); });
}

}  // namespace lorgnette
