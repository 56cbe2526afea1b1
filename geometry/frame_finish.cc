// SPDX-License-Identifier: Apache-2.0
#include "geometry/frame_finish.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace lorgnette {
namespace {

constexpr float kAcetateIndex = 1.49f;  // cellulose acetate

FrameMaterial Finished(FrameFinish finish, const Eigen::Vector3f& color) {
  PbrMaterial pbr;
  pbr.base_color = color;
  pbr.ior = kAcetateIndex;
  switch (finish) {
    case FrameFinish::kMatte:
      pbr.roughness = 0.65f;
      break;
    case FrameFinish::kAcetate:
      pbr.roughness = 0.25f;
      break;
    case FrameFinish::kClear:
      pbr.roughness = 0.15f;
      pbr.transmission = 0.85f;
      break;
    case FrameFinish::kMetal:
      pbr.roughness = 0.25f;
      pbr.metallic = 1;
      break;
  }
  return PhongLike(pbr);
}

Eigen::Vector3f ColorOf(const FrameMaterial& material) {
  if (material.pbr == nullptr) return material.diffuse;
  Eigen::Vector3f color = material.pbr->base_color;
  if (material.pbr->base_color_texture) {
    color = color.cwiseProduct(MeanColor(*material.pbr->base_color_texture));
  }
  return color;
}

FrameMaterial Recolored(const FrameMaterial& material, const Eigen::Vector3f& color) {
  if (material.pbr != nullptr) {
    PbrMaterial pbr = *material.pbr;
    pbr.base_color = color;
    pbr.base_color_texture = nullptr;
    return PhongLike(pbr);
  }
  FrameMaterial out = material;
  out.diffuse = color;
  return out;
}

}  // namespace

const std::vector<std::string>& FrameFinishNames() {
  static const std::vector<std::string> kNames = {"matte", "acetate", "clear", "metal"};
  return kNames;
}

Result<FrameFinish> FindFrameFinish(std::string_view name) {
  const auto& names = FrameFinishNames();
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) {
    return UsageError(
        fmt::format("frame finish: got `{}`, want matte, acetate, clear or metal", name));
  }
  return FrameFinish(at - names.begin());
}

Result<Eigen::Vector3f> ParseFrameColor(std::string_view text) {
  unsigned code = 0;
  const bool shaped = text.size() == 7 && text[0] == '#';
  if (shaped) {
    const auto read = std::from_chars(text.data() + 1, text.data() + 7, code, 16);
    if (read.ec == std::errc() && read.ptr == text.data() + 7) {
      const auto channel = [&](int shift) {
        return LinearFromSrgb(float((code >> shift) & 0xff) / 255);
      };
      return Eigen::Vector3f(channel(16), channel(8), channel(0));
    }
  }
  return UsageError(fmt::format("frame colour: got `{}`, want #RRGGBB", text));
}

void Refinish(std::optional<FrameFinish> finish, const std::optional<Eigen::Vector3f>& color,
              FrameModel& frame) {
  if (!finish && !color) return;
  for (FramePart& part : frame.parts) {
    if (part.kind == FramePartKind::kNosePad || part.kind == FramePartKind::kHinge ||
        part.kind == FramePartKind::kDemoLens) {
      continue;
    }
    part.material = finish ? Finished(*finish, color.value_or(ColorOf(part.material)))
                           : Recolored(part.material, *color);
  }
}

}  // namespace lorgnette
