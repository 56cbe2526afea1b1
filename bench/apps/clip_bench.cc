// SPDX-License-Identifier: Apache-2.0
// The compositor on the frames of a real clip, decoded and tracked beforehand, one after another as
// `lorgnette tryon` draws them: the face moved, the effects planned, everything drawn. One worn
// frame, -6 D, the default light. LORGNETTE_BENCH_CLIP names the video, LORGNETTE_MODELS the folder
// of the converted networks.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>

#include "apps/track_lookup.h"
#include "apps/track_pipeline.h"
#include "apps/tryon_pipeline.h"
#include "bench/calibration.h"
#include "geometry/assemble.h"
#include "geometry/face_motion.h"
#include "geometry/frame_io.h"
#include "geometry/head_occluder.h"
#include "render/compositor.h"
#include "render/environment.h"
#include "render/video_io.h"

namespace lorgnette {
namespace {

BENCHMARK(bench::Calibration)->Name("render/calibration/chain");

constexpr long kFrames = 60;

struct Clip {
  HeadTrack track;
  std::vector<ImageRgb8> pictures;         // those with a face
  std::vector<const TrackedFrame*> poses;  // theirs
  std::vector<std::vector<Eigen::Vector3f>> faces;
  TriangleMesh occluder;
  Environment environment = Environment::Constant({1, 1, 1});
  std::optional<Eyewear> eyewear;
};

Status Load(const std::string& path, Clip& clip) {
  TrackRequest request;
  request.video = path;
  request.frames.last = kFrames - 1;
  LG_ASSIGN(clip.track, TrackVideo(request));
  FrameModel frame = *LoadFrame("panto");
  Prescription rx;
  for (EyePrescription* eye : {&rx.right, &rx.left}) eye->sphere = Diopters(-6);
  LG_ASSIGN(FittedEyewear fitted,
            FitEyewear(frame, clip.track.face, clip.track.pupil_right, clip.track.pupil_left, rx));
  clip.occluder = BuildHeadOccluder(clip.track.face, fitted.fit.ears);
  clip.eyewear = std::move(fitted.eyewear);
  if (const std::string light = DefaultEnvironment(); !light.empty()) {
    LG_ASSIGN(clip.environment, Environment::Read(light));
  }
  LG_ASSIGN(VideoReader reader, VideoReader::Open(path, {.keep_originals = false}));
  const TrackLookup lookup(clip.track, reader.info().frame_rate);
  const FaceMotion motion(clip.track.face, clip.eyewear->frame, clip.eyewear->head_from_frame);
  for (long i = 0; i < kFrames; ++i) {
    LG_ASSIGN(std::optional<VideoFrame> read, reader.Next());
    if (!read) break;
    const TrackedFrame* tracked = lookup.At(read->time_s);
    if (tracked == nullptr || !tracked->found) continue;
    clip.pictures.push_back(std::move(read->rgb));
    clip.poses.push_back(tracked);
    clip.faces.push_back(motion.Held(tracked->vertices));
  }
  return {};
}

// The clip, read once; why there is none in its place.
const Clip* TheClip(std::string& why) {
  static std::string failure;
  static const std::optional<Clip> clip = []() -> std::optional<Clip> {
    const char* path = std::getenv("LORGNETTE_BENCH_CLIP");
    Clip loaded;
    if (path == nullptr) {
      failure = "LORGNETTE_BENCH_CLIP: not set, want a video of a face";
    } else if (const Status status = Load(path, loaded); !status) {
      failure = status.error().message;
    } else if (loaded.pictures.empty()) {
      failure = std::string(path) + ": no frame shows a face";
    } else {
      return loaded;
    }
    return std::nullopt;
  }();
  why = failure;
  return clip ? &*clip : nullptr;
}

Compositor Prepare(const Clip& clip, bool adaptive) {
  CompositorOptions options;
  options.adaptive = adaptive;
  return *Compositor::Create(*clip.eyewear, clip.track.face, clip.occluder, clip.environment,
                             options);
}

ImageRgb8 Draw(const Clip& clip, std::size_t i, Compositor& compositor) {
  if (!clip.faces[i].empty()) compositor.UpdateFace(clip.faces[i]);
  EffectPlan plan;
  return compositor.Render(clip.pictures[i], clip.track.camera, clip.poses[i]->camera_from_head,
                           EffectChoice{}, plan);
}

void DrawFrames(benchmark::State& state, bool adaptive) {
  std::string why;
  const Clip* clip = TheClip(why);
  if (clip == nullptr) {
    state.SkipWithError(why.c_str());
    return;
  }
  Compositor compositor = Prepare(*clip, adaptive);
  benchmark::DoNotOptimize(Draw(*clip, 0, compositor));  // the first bakes the whole face again
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(Draw(*clip, next, compositor));
    next = (next + 1) % clip->pictures.size();
  }
  state.SetItemsProcessed(state.iterations());
  if (!adaptive) return;
  // Against full samples, over the frames.
  Compositor one = Prepare(*clip, true), full = Prepare(*clip, false);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < clip->pictures.size(); ++i) {
    const ImageRgb8 a = Draw(*clip, i, one), b = Draw(*clip, i, full);
    for (std::size_t k = 0; k < a.data.size(); ++k) {
      sum += std::pow(double(a.data[k]) - double(b.data[k]), 2);
    }
    count += double(a.data.size());
  }
  state.counters["psnr_to_full_dB"] = 10 * std::log10(255.0 * 255.0 * count / std::max(sum, 1.0));
}

void BM_ClipFull(benchmark::State& state) { DrawFrames(state, false); }
void BM_ClipAdaptive(benchmark::State& state) { DrawFrames(state, true); }
void BM_ClipBake(benchmark::State& state) {
  std::string why;
  const Clip* clip = TheClip(why);
  if (clip == nullptr) {
    state.SkipWithError(why.c_str());
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(Prepare(*clip, true));
}

void Timed(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
}
BENCHMARK(BM_ClipFull)->Name("render/clip/full_2x2")->Apply(Timed);
BENCHMARK(BM_ClipAdaptive)->Name("render/clip/adaptive")->Apply(Timed);
BENCHMARK(BM_ClipBake)->Name("render/clip/create_and_bake")->Apply(Timed);

}  // namespace
}  // namespace lorgnette
