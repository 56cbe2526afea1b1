// SPDX-License-Identifier: Apache-2.0
#include "apps/effect_options.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace lorgnette {

void AddEffectOptions(CLI::App& command, EffectOptions& options) {
  command
      .add_option("--effects", options.effects,
                  "auto (what exceeds the budget), paper, all or none, then +NAME or -NAME: "
                  "none,+refraction")
      ->capture_default_str();
  command
      .add_option("--budget-px", options.budget_px,
                  "auto leaves out effects that shift the picture by less, pixels")
      ->capture_default_str();
  command
      .add_option("--budget-codes", options.budget_codes,
                  "... and that change it by less, code values of 255")
      ->capture_default_str();
  command
      .add_option(
          "--coating", options.coating,
          "none, single, v, ar, mirror, mirror-blue, -green, -gold, -red; FRONT/BACK: mirror/none")
      ->capture_default_str();
  command
      .add_option("--tint", options.tint,
                  "COLOUR:PERCENT[:dip|solid|gradient]: grey, brown, green, blue, rose, yellow")
      ->capture_default_str();
  command.add_option("--edge", options.edge, "Edge of the lenses: ground or polished");
  command
      .add_option("--wavelengths", options.wavelengths, "Of the dispersion effect, a multiple of 3")
      ->capture_default_str();
}

Result<EffectChoice> ApplyEffectOptions(const EffectOptions& options, CompositorOptions& out) {
  LG_ASSIGN(EffectChoice choice, ParseEffects(options.effects));
  if (!(options.budget_px >= 0)) {
    return UsageError(fmt::format("--budget-px: got {}, want 0 or more", options.budget_px));
  }
  if (!(options.budget_codes >= 0)) {
    return UsageError(fmt::format("--budget-codes: got {}, want 0 or more", options.budget_codes));
  }
  constexpr int kMostWavelengths = 30;
  if (options.wavelengths < 3 || options.wavelengths > kMostWavelengths ||
      options.wavelengths % 3 != 0) {
    return UsageError(fmt::format("--wavelengths: got {}, want a multiple of 3, 3..{}",
                                  options.wavelengths, kMostWavelengths));
  }
  choice.budget = {options.budget_px, options.budget_codes};
  LG_RETURN_IF_ERROR(SetCoating(options.coating, out.finish));
  LG_RETURN_IF_ERROR(SetTint(options.tint, out.finish));
  if (!options.edge.empty()) LG_RETURN_IF_ERROR(SetEdge(options.edge, out.finish));
  out.wavelengths = options.wavelengths;
  return choice;
}

}  // namespace lorgnette
