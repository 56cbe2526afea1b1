// SPDX-License-Identifier: Apache-2.0
// A whole picture: samples a pixel, adaptive or not, effects one by one, resolution, presets.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/color.h"
#include "render/quality.h"
#include "validation/cost/scene.h"
#include "validation/cost/studies.h"

namespace lorgnette::validation {
namespace {

constexpr int kReferenceSide = 32, kReferenceShadowRays = 4096;

// Root mean square and greatest difference in code values of an 8-bit display, without rounding,
// over the pixels that the glasses change.
class PictureError {
 public:
  PictureError(const ImageRgbF& input, const ImageRgbF& reference) : reference_(reference) {
    const std::size_t n = input.data.size() / 3;
    for (std::size_t i = 0; i < n; ++i) {
      if (!std::equal(&input.data[3 * i], &input.data[3 * i] + 3, &reference.data[3 * i])) {
        changed_.push_back(i);
      }
    }
  }
  std::size_t pixels() const { return changed_.size(); }
  void Put(const ImageRgbF& picture, CostPoint& point) const {
    double squares = 0, worst = 0;
    for (const std::size_t i : changed_) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double error = Code(picture.data[3 * i + c]) - Code(reference_.data[3 * i + c]);
        squares += error * error;
        worst = std::max(worst, std::abs(error));
      }
    }
    point.errors = {std::sqrt(squares / (3 * double(std::max<std::size_t>(1, changed_.size()))))};
    point.worst = {worst};
  }

 private:
  static double Code(float linear) {
    return 255 * SrgbFromLinear(std::clamp(double(linear), 0.0, 1.0));
  }
  const ImageRgbF& reference_;
  std::vector<std::size_t> changed_;
};

}  // namespace

Result<CostStudy> PictureStudy(const WornScene& scene, const CostOptions& options) {
  const auto create = [&](const CompositorOptions& o) {
    return Compositor::Create(scene.eyewear, scene.face, scene.occluder, scene.environment, o);
  };
  CompositorOptions best = scene.options;
  ApplyQuality(*FindQuality("reference"), best);
  best.samples_per_side = kReferenceSide;
  best.shadow = ShadowMode::kPaper;
  best.shadow_rays = kReferenceShadowRays;
  LG_ASSIGN(const Compositor reference_maker, create(best));
  const ImageRgbF reference =
      reference_maker.Render(scene.input, scene.camera, scene.camera_from_head);
  const PictureError error(scene.input, reference);

  CostStudy study;
  study.name = "picture";
  study.title =
      fmt::format("A whole picture, {} x {} pixels", scene.camera.width, scene.camera.height);
  study.reference = fmt::format(
      "{} samples a pixel, {} rays of shadow at each, over the {} pixels that the glasses change; "
      "{}",
      kReferenceSide * kReferenceSide, kReferenceShadowRays, error.pixels(), scene.name);
  study.time_unit = "ms/frame";
  study.ms_per_frame = 1;
  study.units = {{"levels", "of 255 on the display, over the pixels that the glasses change"}};

  StopwatchOptions stopwatch = options.stopwatch;
  stopwatch.min_repetitions = std::min(stopwatch.min_repetitions, 5);
  const auto add = [&](const std::string& method, const std::string& parameter,
                       const CompositorOptions& o, int shrink = 1,
                       const char* preset = "") -> Status {
    LG_ASSIGN(const Compositor compositor, create(o));
    const ImageRgbF input = shrink > 1 ? Shrunk(scene.input, shrink) : scene.input;
    const Camera camera = shrink > 1 ? Shrunk(scene.camera, shrink) : scene.camera;
    ImageRgbF picture;
    const Timing timing = TimeOf(
        [&] {
          picture = compositor.Render(input, camera, scene.camera_from_head);
          if (shrink > 1) picture = Grown(picture, shrink, scene.input);
        },
        stopwatch);
    CostPoint point;
    point.method = method;
    point.parameter = parameter;
    point.preset = preset;
    point.time = 1e-6 * timing.median_ns;
    point.time_spread = 1e-6 * timing.spread_ns;
    error.Put(picture, point);
    study.points.push_back(std::move(point));
    return {};
  };

  CompositorOptions standard = scene.options;
  ApplyQuality(*FindQuality("standard"), standard);
  for (const QualityPreset& preset : QualityPresets()) {
    CompositorOptions o = scene.options;
    ApplyQuality(preset, o);
    LG_RETURN_IF_ERROR(add("preset", preset.name, o, 1, preset.name));
  }
  for (const bool adaptive : {false, true}) {
    for (const int side : {1, 2, 3, 4, 6, 8}) {
      if (adaptive && side <= standard.samples_per_side) continue;  // one sample; the standard
      CompositorOptions o = standard;
      o.samples_per_side = side;
      o.adaptive = adaptive;
      LG_RETURN_IF_ERROR(add(adaptive ? "samples where it changes" : "samples everywhere",
                             fmt::format("{} a pixel", side * side), o));
    }
  }
  for (const int factor : {2, 4}) {
    LG_RETURN_IF_ERROR(add("smaller picture, enlarged", fmt::format("1/{} of the side", factor),
                           standard, factor));
  }
  // The effects of the paper's model, one by one.
  for (int k = 0; k < kEffectCount; ++k) {
    CompositorOptions o = standard;
    if (!o.effects[Effect(k)]) continue;
    o.effects.Set(Effect(k), false);
    LG_RETURN_IF_ERROR(add("standard without", std::string(EffectName(Effect(k))), o));
  }
  CompositorOptions solid = standard;
  solid.fade_temples = false;
  LG_RETURN_IF_ERROR(add("standard without", "fading temples", solid));
  MarkFront(study);
  return study;
}

}  // namespace lorgnette::validation
