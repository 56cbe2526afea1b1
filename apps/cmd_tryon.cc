// SPDX-License-Identifier: Apache-2.0
// lorgnette tryon: the main job.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <ostream>

#include "apps/commands.h"
#include "apps/effect_options.h"
#include "apps/lens_options.h"
#include "apps/tryon_pipeline.h"
#include "render/quality.h"

namespace lorgnette {
namespace {

struct TryonCommandOptions {
  TryonRequest request;
  std::string frames;
  std::string quality = "standard", shadow;  // shadow empty: as the quality says
  std::optional<int> samples;
  bool adaptive = false;
  bool no_refraction = false, no_reflection = false, no_shadow = false;
  EffectOptions effects;
  std::vector<double> nudge;
  std::string frame_finish, frame_color;  // empty: the frame's own
  std::string medium = "CR-39";
  std::optional<double> index;
};

constexpr int kMaxSamplesPerSide = 8;
constexpr double kMaxNudge_mm = 30, kMaxNudge_deg = 30;

Status ApplyNudge(const std::vector<double>& nudge, FitOptions& fit) {
  if (nudge.empty()) return {};
  if (nudge.size() != 3 && nudge.size() != 6) {
    return UsageError(
        fmt::format("--nudge: got {} numbers, want X,Y,Z in mm, or X,Y,Z,RX,RY,RZ "
                    "with degrees",
                    nudge.size()));
  }
  for (std::size_t i = 0; i < nudge.size(); ++i) {
    const double limit = i < 3 ? kMaxNudge_mm : kMaxNudge_deg;
    if (!(std::abs(nudge[i]) <= limit)) {
      return UsageError(fmt::format("--nudge: got {}, want {}..{}", nudge[i], -limit, limit));
    }
    (i < 3 ? fit.nudge_mm : fit.nudge_deg)[static_cast<Eigen::Index>(i % 3)] = nudge[i];
  }
  return {};
}

Status RunTryonCommand(TryonCommandOptions options, std::ostream& out) {
  TryonRequest& request = options.request;
  LG_ASSIGN(request.frames, ParseFrameRange(options.frames));
  if (!request.camera.empty() && (request.focal_px > 0 || !request.track.empty())) {
    return UsageError(fmt::format("--camera: got it with {}, want one of the two",
                                  request.track.empty() ? "--focal" : "--track"));
  }
  LG_RETURN_IF_ERROR(ApplyNudge(options.nudge, request.fit));
  CompositorOptions& compositor = request.compositor;
  if (const QualityPreset* preset = FindQuality(options.quality)) ApplyQuality(*preset, compositor);
  if (options.samples) {
    compositor.samples_per_side = *options.samples;
    compositor.adaptive = false;
  }
  if (options.adaptive) compositor.adaptive = true;
  if (compositor.samples_per_side < 1 || compositor.samples_per_side > kMaxSamplesPerSide) {
    return UsageError(fmt::format("--samples: got {}, want 1..{}", compositor.samples_per_side,
                                  kMaxSamplesPerSide));
  }
  LensOptions lens;
  lens.medium = options.medium;
  lens.index = options.index;
  LG_ASSIGN(const MediumEntry medium, MediumOf(lens));
  request.eyewear.medium = medium.medium;
  request.eyewear.min_center_thickness_mm = medium.min_center_mm;
  request.eyewear.min_edge_thickness_mm = medium.min_edge_mm;
  if (!options.frame_finish.empty()) {
    LG_ASSIGN(request.frame_finish, FindFrameFinish(options.frame_finish));
  }
  if (!options.frame_color.empty()) {
    LG_ASSIGN(request.frame_color, ParseFrameColor(options.frame_color));
  }
  LG_ASSIGN(request.effects, ApplyEffectOptions(options.effects, compositor));
  const auto without = [&](Effect effect) {
    request.effects.wish[std::size_t(effect)] = EffectWish::kOff;
  };
  if (options.no_refraction) without(Effect::kRefraction);
  if (options.no_reflection) {
    for (const Effect effect :
         {Effect::kFrontReflection, Effect::kBackReflection, Effect::kRings, Effect::kBounces}) {
      without(effect);
    }
  }
  if (options.no_shadow) {
    compositor.shadow = ShadowMode::kNone;
  } else if (!options.shadow.empty()) {
    compositor.shadow = options.shadow == "paper" ? ShadowMode::kPaper : ShadowMode::kBaked;
  }
  LG_ASSIGN(const TryonResult result, RunTryon(request));
  out << fmt::format("{}: {} frames, {} without a face, {:.1f} s\n", request.output, result.frames,
                     result.frames_without_face, result.seconds.wall);
  for (const std::string& still : result.stills) out << still << '\n';
  if (!request.report.empty()) out << request.report << '\n';
  if (!request.oma.empty()) out << request.oma << '\n';
  return {};
}

}  // namespace

void AddTryonCommand(CLI::App& program, CommandContext& context) {
  CLI::App& command = *program.add_subcommand(
      "tryon", "Put prescription glasses on the face in a video; write video, stills and report");
  const auto options = std::make_shared<TryonCommandOptions>();
  TryonRequest& request = options->request;
  command.add_option("--video", request.video, "Video, image sequence (name_%04d.png) or image")
      ->required();
  command.add_option("--rx", request.rx, "Prescription file (JSON)")->required();
  command.add_option("--frame", request.frame, "Shipped frame by name (lorgnette frames), or file")
      ->required();
  command
      .add_option("-o,--output", request.output,
                  "Video (.mp4 .mov .mkv), image sequence, or image for one image")
      ->required();
  command.add_option("--env", request.environment,
                     "Light: EXR or HDR, latitude-longitude, or `face`: as the face shows it");
  command.add_option("--track", request.track, "Track file, in place of tracking the video");
  command.add_option("--frames", options->frames, "Part of the clip, A:B, first and last frame");
  command.add_option("--stills", request.stills, "Also write this many stills beside the output")
      ->check(CLI::Range(0, 1000));
  command.add_flag("--beside", request.stills_beside_input, "Stills show the input at the left");
  command.add_option("--report", request.report, "Write a report (JSON)");
  command.add_flag(
      "--resume", request.resume,
      "Keep what is drawn in OUTPUT.resume until the output is whole; the same command "
      "after a kill goes on from there, with the same result");
  AddEffectOptions(command, options->effects);
  command.add_option("--oma", request.oma,
                     "Write the lenses' results for a lab (OMA): into a copy of the frame's or the "
                     "prescription's OMA job, or a new one");
  command.add_option("--unit", request.frame_unit_mm,
                     "Millimetres in one unit of the frame file, where it does not say");
  command.add_option("--frame-color", options->frame_color, "Colour of the frame, #RRGGBB");
  command
      .add_option("--frame-finish", options->frame_finish,
                  "Finish of the frame, in place of its own")
      ->check(CLI::IsMember(FrameFinishNames()));
  command.add_flag("--no-refraction", options->no_refraction, "Leave out refraction");
  command.add_flag("--no-reflection", options->no_reflection, "Leave out reflection");
  command.add_flag("--no-shadow", options->no_shadow, "Leave out the shadow");
  std::vector<std::string> presets;
  for (const QualityPreset& preset : QualityPresets()) presets.emplace_back(preset.name);
  command
      .add_option("--quality", options->quality,
                  "Samples, directions of light and bounces by name; options below go before it")
      ->capture_default_str()
      ->check(CLI::IsMember(presets));
  command
      .add_option("--shadow", options->shadow,
                  "Shadow: baked (fast; the default) or paper (Algorithm 1)")
      ->check(CLI::IsMember({"baked", "paper"}));
  command
      .add_option("--medium", options->medium,
                  "Lens material: CR-39, crown, Trivex, polycarbonate, 1.60, 1.67, 1.74")
      ->capture_default_str();
  command.add_option("--index", options->index, "Refractive index, for the material's");
  command.add_option("--pd", request.pd_mm,
                     "Distance between the pupils, mm, for the prescription's");
  command.add_option("--samples", options->samples,
                     "Samples a pixel along each side, at every pixel");
  command.add_flag("--adaptive", options->adaptive,
                   "With --samples: all of them only where the picture needs them, one elsewhere");
  command
      .add_option("--nudge", options->nudge,
                  "Move the glasses after the fit: X,Y,Z in mm (wearer's left, up, forward), "
                  "then turns about them in degrees")
      ->delimiter(',');
  command.add_option("--focal", request.focal_px, "Focal length, pixels (estimated if absent)");
  command.add_option("--camera", request.camera,
                     "Camera file of lorgnette calibrate, in place of --focal");
  command.add_option("--models", request.model_dir, "Folder of the face networks");
  command.footer(
      "Examples:\n"
      "  lorgnette tryon --video clip.mp4 --rx rx.json --frame panto -o tryon.mp4\n"
      "  lorgnette tryon --video clip.mp4 --rx rx.json --frame round --env studio.exr \\\n"
      "      --frames 100:199 --stills 4 --report report.json -o part.mp4\n"
      "  lorgnette tryon --video portrait.png --rx rx.json --frame aviator -o portrait_on.png");
  command.final_callback([options, &context] {
    options->request.command_line = context.command_line;
    context.status = RunTryonCommand(*options, context.out);
  });
}

}  // namespace lorgnette
