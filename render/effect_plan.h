// SPDX-License-Identifier: Apache-2.0
// Which effects a picture needs: for each, what it could change at most, in pixels and in code
// values, from the optics of the lens, the pose, the resolution, the light and the finish. What
// stays below the budget is left out, as long as everything left out together stays below it.
//
// Source: docs/rendering.md, "Only what the scene calls for". Tested both ways: the planned picture
// against all effects, within the budget at every pixel; and scenes that need one effect, where
// leaving that one out exceeds it.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/camera.h"
#include "base/image.h"
#include "base/result.h"
#include "render/effects.h"
#include "render/input_picture.h"

namespace lorgnette {

struct HeadScene;
class PictureView;

struct EffectBudget {
  double shift_px = 0.25;
  double code_values = 1;  // of 255, display-encoded
};

enum class EffectWish : std::uint8_t { kEstimate, kOn, kOff };

// What a user asks for.
struct EffectChoice {
  std::array<EffectWish, kEffectCount> wish{};
  EffectBudget budget;
};
// `auto` (by estimate), `paper`, `all` or `none`, then `+NAME` and `-NAME`, with commas:
// "none,+refraction", "auto,-shadow".
Result<EffectChoice> ParseEffects(std::string_view text);

// Regions that are decided apart.
enum class EffectRegion : std::uint8_t { kRightLens, kLeftLens, kRest };

struct EffectDecision {
  Effect effect = Effect::kRefraction;
  EffectRegion region = EffectRegion::kRest;
  double shift_px = 0, code_values = 0;  // estimates of the largest change
  double cost_ms = 0;                    // processor time of this picture, a rough figure
  bool on = true;
  std::string reason;
};

struct EffectPlan {
  PictureEffects effects;
  std::vector<EffectDecision> decisions;
};

// The plan of one picture, which `view` shows.
EffectPlan PlanEffects(const HeadScene& head, const PictureView& view, const InputPicture& input,
                       const Camera& camera, const Eigen::Isometry3d& camera_from_head,
                       const EffectChoice& choice);

// A report as JSON text: an array of {effect, region, shift_px, code_values, on, reason, cost_ms}.
std::string EffectPlanJson(const EffectPlan& plan);

}  // namespace lorgnette
