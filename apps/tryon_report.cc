// SPDX-License-Identifier: Apache-2.0
#include "apps/tryon_report.h"

#include <nlohmann/json.hpp>

#include "apps/lens_json.h"
#include "apps/program.h"

namespace lorgnette {
namespace {

using Json = nlohmann::ordered_json;

Json LensReport(const CutLens& cut) {
  const LensDesign& design = cut.lens.design();
  Json json = LensJson(design, MakeLensSheet(design, SheetRequest{}));
  json["mount_misfit_mm"] = cut.mount_misfit_mm;
  json["certificate"] = CertificateJson(cut.lens.certificate());
  return json;
}

Json WearingJson(const TryonResult& result) {
  const WearingPosition& w = result.eyewear->wearing;
  return {{"vertex_distance_mm", {w.vertex_distance_right_mm, w.vertex_distance_left_mm}},
          {"pantoscopic_tilt_deg", w.pantoscopic_tilt_deg},
          {"face_form_deg", w.face_form_deg},
          {"fitting_height_mm", {w.fitting_height_right_mm, w.fitting_height_left_mm}},
          {"nose_penetration_mm", w.nose_penetration_mm},
          {"nose_gap_mm", w.nose_gap_mm},
          {"pad_shift_mm", result.pad_shift_mm},
          {"temple_opening_deg", result.temple_opening_deg},
          {"notes", w.notes}};
}

Json FrameJson(const FrameModel& frame) {
  return {{"name", frame.name},
          {"a_mm", frame.boxing.a_mm},
          {"b_mm", frame.boxing.b_mm},
          {"dbl_mm", frame.boxing.dbl_mm},
          {"notes", frame.notes}};
}

Json VideoJson(const TryonResult& r) {
  const auto range = [&](double HeadAngles::*angle) {
    return Json{r.least.*angle, r.greatest.*angle};
  };
  const LensDistortion& d = r.distortion;
  Json iris;  // null where the irises were not seen
  if (r.iris_pd_mm > 0) {
    iris = {{"pd_mm", r.iris_pd_mm},
            {"sigma_mm", r.iris_pd_sigma_mm},
            {"minus_prescribed_mm", r.iris_pd_mm - r.pd_mm}};
  }
  return {{"input", r.request.video},
          {"output", r.request.output},
          {"width", r.width},
          {"height", r.height},
          {"frame_rate", r.frame_rate},
          {"frames", r.frames},
          {"frames_without_face", r.frames_without_face},
          {"sound_copied", r.has_audio},
          {"yaw_deg", range(&HeadAngles::yaw)},
          {"pitch_deg", range(&HeadAngles::pitch)},
          {"roll_deg", range(&HeadAngles::roll)},
          {"focal_px", r.camera.fx},
          {"distortion", {d.k1, d.k2, d.p1, d.p2, d.k3}},
          {"pd_mm", r.pd_mm},
          {"iris_pd", iris},
          {"residual_px", r.mean_residual_px},
          {"stills", r.stills}};
}

// The first frame's plan, and in how many frames each effect was drawn.
Json EffectsJson(const TryonResult& r) {
  Json list = Json::parse(EffectPlanJson(r.first_plan));
  for (std::size_t i = 0; i < list.size(); ++i) {
    const EffectDecision& d = r.first_plan.decisions[i];
    list[i]["frames_on"] = r.effect_frames[std::size_t(d.region)][std::size_t(d.effect)];
  }
  return list;
}

Json RenderJson(const TryonResult& r) {
  const CompositorOptions& o = r.request.compositor;
  const char* shadow = o.shadow == ShadowMode::kNone    ? "none"
                       : o.shadow == ShadowMode::kPaper ? "paper"
                                                        : "baked";
  return {{"effects", EffectsJson(r)},
          {"shadow", shadow},
          {"samples_per_pixel", o.samples_per_side * o.samples_per_side},
          {"environment", r.environment},
          {"environment_scale", r.environment_scale},
          {"lens_pixels", r.counts.lens_pixels},
          {"frame_pixels", r.counts.frame_pixels},
          {"shadowed_pixels", r.counts.shadowed_pixels},
          {"filled_samples", r.counts.filled_samples}};
}

}  // namespace

std::string TryonReportJson(const TryonResult& r) {
  const StageSeconds& s = r.seconds;
  const Json document = {{"program", std::string("lorgnette ") + ProgramVersion()},
                         {"prescription", r.request.rx},
                         {"frame", FrameJson(r.eyewear->frame)},
                         {"lenses", {LensReport(r.eyewear->right), LensReport(r.eyewear->left)}},
                         {"wearing_position", WearingJson(r)},
                         {"video", VideoJson(r)},
                         {"rendering", RenderJson(r)},
                         {"seconds",
                          {{"track", s.track},
                           {"design", s.design},
                           {"prepare", s.prepare},
                           {"read", s.read},
                           {"render", s.render},
                           {"write", s.write},
                           {"wall", s.wall}}},
                         {"warnings", r.warnings}};
  return document.dump(2) + '\n';
}

}  // namespace lorgnette
