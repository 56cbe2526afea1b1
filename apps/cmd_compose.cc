// SPDX-License-Identifier: Apache-2.0
// lorgnette compose: one picture from a scene that a JSON file states in full.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <ostream>

#include "apps/commands.h"
#include "apps/effect_options.h"
#include "base/atomic_file.h"
#include "render/compose.h"
#include "render/image_io.h"

namespace lorgnette {
namespace {

struct ComposeCommandOptions {
  std::string scene, output, hits, report;
  bool caustics = false;
  EffectOptions effects;
};

Status CheckExr(const char* option, const std::string& path) {
  if (path.empty() || path.ends_with(".exr")) return {};
  return UsageError(fmt::format("{}: got {}, want a name that ends in .exr", option, path));
}

Status RunCompose(const ComposeCommandOptions& options, std::ostream& out) {
  LG_RETURN_IF_ERROR(CheckExr("--output", options.output));
  LG_RETURN_IF_ERROR(CheckExr("--hits", options.hits));
  CompositorOptions probe;  // options are checked before anything is read
  LG_ASSIGN(EffectChoice choice, ApplyEffectOptions(options.effects, probe));
  if (options.caustics) choice.wish[std::size_t(Effect::kLensLight)] = EffectWish::kOn;
  LG_ASSIGN(ComposeCase scene, ReadComposeCase(options.scene));
  LG_RETURN_IF_ERROR(ApplyEffectOptions(options.effects, scene.options).map([](auto&&) {}));
  LG_ASSIGN(const ComposeOutput output, Compose(scene, choice));
  LG_RETURN_IF_ERROR(WriteExr(output.picture, options.output, ExrDepth::kFloat));
  if (!options.hits.empty()) {
    LG_RETURN_IF_ERROR(WriteExr(output.hits, options.hits, ExrDepth::kFloat));
  }
  if (!options.report.empty()) {
    LG_RETURN_IF_ERROR(WriteFileAtomically(
        options.report, fmt::format("{{\n\"effects\": {}\n}}\n", EffectPlanJson(output.plan))));
  }
  out << fmt::format("{}: {}x{} pixels, {} on lenses, {} on the frame\n", options.output,
                     output.picture.width, output.picture.height, output.counts.lens_pixels,
                     output.counts.frame_pixels);
  return {};
}

}  // namespace

void AddComposeCommand(CLI::App& program, CommandContext& context) {
  CLI::App& command = *program.add_subcommand(
      "compose", "Render one picture from a scene file: camera, meshes, lenses, light (EXR)");
  const auto options = std::make_shared<ComposeCommandOptions>();
  command.add_option("scene", options->scene, "Scene file (JSON, docs/rendering.md)")->required();
  command.add_option("-o,--output", options->output, "Picture to write (EXR, linear light)")
      ->required();
  command.add_option("--hits", options->hits,
                     "Also write what the ray of every pixel reaches (EXR, R G B: mm, A: code)");
  command.add_flag("--caustics", options->caustics,
                   "Light the skin through the lenses, too (the effect lens-light)");
  command.add_option("--report", options->report, "Write the effects and their estimates (JSON)");
  options->effects.effects = "paper";
  AddEffectOptions(command, options->effects);
  command.footer(
      "Examples:\n"
      "  lorgnette compose scene.json -o picture.exr\n"
      "  lorgnette compose scene.json -o picture.exr --hits hits.exr");
  command.final_callback(
      [options, &context] { context.status = RunCompose(*options, context.out); });
}

}  // namespace lorgnette
