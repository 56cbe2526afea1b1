// SPDX-License-Identifier: Apache-2.0
// Another colour or finish for a frame, as its wearer would choose it in a shop.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "geometry/frame_model.h"

namespace lorgnette {

enum class FrameFinish {
  kMatte,    // rubbed acetate: hardly any gloss
  kAcetate,  // polished acetate
  kClear,    // transparent acetate: its colour is that of the light that comes through
  kMetal,    // polished metal of that colour
};

// The names, in the order above: matte, acetate, clear, metal.
const std::vector<std::string>& FrameFinishNames();
// An unknown name is a usage error.
Result<FrameFinish> FindFrameFinish(std::string_view name);
// #RRGGBB, display-encoded, as linear Rec.709; anything else is a usage error.
Result<Eigen::Vector3f> ParseFrameColor(std::string_view text);

// Lays it over front, temples and other parts; pads, hinges and demo lenses stay. Without `finish`
// each part keeps its gloss, without `color` its colour; textures go.
void Refinish(std::optional<FrameFinish> finish, const std::optional<Eigen::Vector3f>& color,
              FrameModel& frame);

}  // namespace lorgnette
