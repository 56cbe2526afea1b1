// SPDX-License-Identifier: Apache-2.0
// The options of every command that draws lenses: effects and their budget, coats, tint, edge.
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "render/compositor.h"

namespace CLI {
class App;
}

namespace lorgnette {

struct EffectOptions {
  std::string effects = "auto", coating = "none", tint = "none", edge;
  double budget_px = 0.25, budget_codes = 1;
  int wavelengths = 3;
};
// --effects, --budget, --coating, --tint, --edge, --wavelengths. An empty `edge` is the command's
// own default.
void AddEffectOptions(CLI::App& command, EffectOptions& options);
// Checks them and sets the finish; the choice decides each picture's plan.
Result<EffectChoice> ApplyEffectOptions(const EffectOptions& options, CompositorOptions& out);

}  // namespace lorgnette
