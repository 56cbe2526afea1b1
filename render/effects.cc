// SPDX-License-Identifier: Apache-2.0
#include "render/effects.h"

namespace lorgnette {
namespace {

constexpr std::array<std::string_view, kEffectCount> kNames = {
    "refraction", "dispersion", "front-reflection", "back-reflection", "rings",       "bounces",
    "coating",    "tint",       "shadow",           "lens-light",      "frame-gloss", "grain"};

}  // namespace

std::string_view EffectName(Effect effect) { return kNames[std::size_t(effect)]; }

std::optional<Effect> FindEffect(std::string_view name) {
  for (int i = 0; i < kEffectCount; ++i) {
    if (kNames[std::size_t(i)] == name) return Effect(i);
  }
  return std::nullopt;
}

EffectSet EffectSet::Paper() {
  EffectSet set = All();
  set.Set(Effect::kDispersion, false);
  set.Set(Effect::kLensLight, false);
  set.Set(Effect::kGrain, false);
  return set;
}

}  // namespace lorgnette
