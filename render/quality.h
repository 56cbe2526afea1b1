// SPDX-License-Identifier: Apache-2.0
// The compositor's quality by name: points of what accuracy costs in time (docs/cost.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/compositor.h"

namespace lorgnette {

struct QualityPreset {
  const char* name;
  const char* meaning;
  // Only what concerns quality; effects and scene stay the caller's.
  int samples_per_side;
  bool adaptive;
  ShadowMode shadow;
  int shadow_directions;  // baked
  int max_internal_bounces;
  double least_weight;
};

const std::vector<QualityPreset>& QualityPresets();
// nullptr where there is none of that name.
const QualityPreset* FindQuality(const std::string& name);
void ApplyQuality(const QualityPreset& preset, CompositorOptions& options);

}  // namespace lorgnette
