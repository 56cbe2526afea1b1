// SPDX-License-Identifier: Apache-2.0
// The main job: a video of a face, a prescription and a frame in; the video with the glasses on,
// stills and a report out. Every lens in it has passed Certify.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "apps/frame_range.h"
#include "base/result.h"
#include "geometry/assemble.h"
#include "geometry/fit.h"
#include "geometry/frame_finish.h"
#include "render/compositor.h"
#include "tracking/head_track.h"

namespace lorgnette {

struct TryonRequest {
  std::string video, rx, frame, output;
  std::string environment;  // EXR or HDR; empty: DefaultEnvironment(), or even grey light; `face`:
                            // that, with the broad light that the face shows
  std::string track;        // track file; empty: the video is tracked
  std::string report;       // empty: none
  std::string oma;          // lens results for the lab; empty: none
  // Keeps what was drawn beside the output, and continues from what an earlier run kept.
  bool resume = false;
  std::string command_line;                    // tells this run from others, for `resume`
  std::optional<double> frame_unit_mm;         // of a frame file that does not say
  std::optional<FrameFinish> frame_finish;     // in place of the frame's own
  std::optional<Eigen::Vector3f> frame_color;  // linear Rec.709, in place of the frame's own
  std::string model_dir;
  FrameRange frames;
  std::optional<double> pd_mm;  // in place of the prescription's
  double focal_px = 0;          // for tracking; 0: estimated
  std::string camera;           // camera file, for tracking; empty: not calibrated
  int stills = 0;
  bool stills_beside_input = false;
  CompositorOptions compositor;
  EffectChoice effects;  // decided for every frame
  FitOptions fit;
  EyewearOptions eyewear;
};

// Degrees; of the head against the camera: yaw is positive when the head turns to its left, pitch
// when it looks up, roll when it leans toward its left shoulder.
struct HeadAngles {
  double yaw = 0, pitch = 0, roll = 0;
};
HeadAngles AnglesOf(const Eigen::Isometry3d& camera_from_head);

// Seconds of work by stage; reading, rendering and writing overlap, so that their sum may exceed
// the wall time.
struct StageSeconds {
  double track = 0, design = 0, prepare = 0, read = 0, render = 0, write = 0;
  double wall = 0;
};

struct TryonResult {
  TryonRequest request;
  long frames = 0, frames_without_face = 0;
  double frame_rate = 0;
  int width = 0, height = 0;
  bool has_audio = false;
  Camera camera;
  LensDistortion distortion;
  double pd_mm = 0, iris_pd_mm = 0, iris_pd_sigma_mm = 0;  // HeadTrack's
  HeadAngles least, greatest;                              // over the frames with a face
  double mean_residual_px = 0;
  std::string environment;  // what lit the scene
  double environment_scale = 1;
  Prescription prescription;
  std::optional<Eyewear> eyewear;                                 // always there in a result
  double pad_shift_mm = 0, temple_opening_deg = 0;                // adjustments of the frame
  RenderCounts counts;                                            // sums over the frames
  EffectPlan first_plan;                                          // of the first frame with a face
  std::array<std::array<long, kEffectCount>, 3> effect_frames{};  // by region: drawn in how many
  std::vector<std::string> stills, warnings;
  StageSeconds seconds;
};

// Runs the job; progress goes to standard error. On an error no file has appeared under its name.
Result<TryonResult> RunTryon(const TryonRequest& request);

// cache/inputs/environment.exr beside the models, when it is there; else empty.
std::string DefaultEnvironment();

}  // namespace lorgnette
