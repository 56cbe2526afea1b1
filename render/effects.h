// SPDX-License-Identifier: Apache-2.0
// The effects that a picture can be drawn with, one switch each. render/effect_plan.h decides them
// by estimate; the command line can force any.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace lorgnette {

enum class Effect {
  kRefraction,       // rays bend at both surfaces; without: they pass straight
  kDispersion,       // the index of each colour channel's own light
  kFrontReflection,  // what the first surface mirrors
  kBackReflection,   // what the second surface mirrors, out again through the first
  kRings,            // internal reflections that reach the edge of the lens
  kBounces,          // ghosts: second and later internal reflections
  kCoating,          // the coats' reflectance by angle and colour; without: bare glass
  kTint,             // absorption along the path in the glass
  kShadow,           // of the frame on the skin, equation (2)
  kLensLight,        // light that reaches the skin through the lenses: tint's shadow, caustics
  kGloss,            // highlights of the frame
  kGrain,            // inserted pixels take on the video's grain
  kCount
};
inline constexpr int kEffectCount = int(Effect::kCount);

// "refraction", "front-reflection", ...: as options and reports spell it.
std::string_view EffectName(Effect effect);
std::optional<Effect> FindEffect(std::string_view name);

// A set of effects.
class EffectSet {
 public:
  static EffectSet None() { return {}; }
  static EffectSet All() {
    EffectSet set;
    set.on_.fill(true);
    return set;
  }
  // All but dispersion, light through the lenses and grain: the paper's model.
  static EffectSet Paper();
  bool operator[](Effect effect) const { return on_[std::size_t(effect)]; }
  void Set(Effect effect, bool on) { on_[std::size_t(effect)] = on; }
  bool operator==(const EffectSet&) const = default;

 private:
  std::array<bool, kEffectCount> on_{};
};

// One picture's effects by region: what concerns glass may differ between the lenses; the rest of
// the picture (skin, frame) takes `rest`.
struct PictureEffects {
  EffectSet lens[2];  // right, left
  EffectSet rest;
  // Dispersion of a lens is drawn where it moves a colour by more than this, in pixels.
  double dispersion_from_px[2] = {0, 0};
  static PictureEffects Of(const EffectSet& set) { return {{set, set}, set}; }
  bool Any(Effect effect) const { return lens[0][effect] || lens[1][effect] || rest[effect]; }
};

}  // namespace lorgnette
