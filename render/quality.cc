// SPDX-License-Identifier: Apache-2.0
#include "render/quality.h"

namespace lorgnette {

const std::vector<QualityPreset>& QualityPresets() {
  using enum ShadowMode;
  static const std::vector<QualityPreset> kPresets = {
      {"draft", "one sample a pixel, 256 directions of light", 1, false, kBaked, 256, 1, 0.02},
      {"standard", "2 x 2 samples where anything changes, 1024 directions", 2, true, kBaked, 1024,
       4, 0.004},
      {"reference", "8 x 8 samples everywhere, 2048 directions, 12 bounces in the glass", 8, false,
       kBaked, 2048, 12, 0.0005},
      {"paper", "2 x 2 samples and 160 rays of shadow a pixel, as published", 2, false, kPaper,
       1024, 4, 0.004},
  };
  return kPresets;
}

const QualityPreset* FindQuality(const std::string& name) {
  for (const QualityPreset& preset : QualityPresets()) {
    if (name == preset.name) return &preset;
  }
  return nullptr;
}

void ApplyQuality(const QualityPreset& preset, CompositorOptions& options) {
  options.samples_per_side = preset.samples_per_side;
  options.adaptive = preset.adaptive;
  options.shadow = preset.shadow;
  options.shadow_directions = preset.shadow_directions;
  options.max_internal_bounces = preset.max_internal_bounces;
  options.least_weight = preset.least_weight;
}

}  // namespace lorgnette
