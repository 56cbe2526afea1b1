// SPDX-License-Identifier: Apache-2.0
// Speed of tracking on one core, decoding apart. LORGNETTE_BENCH_FRAMES names a file of raw
// rgb24 frames of a face, 1280 x 720; LORGNETTE_MODELS the folder of the converted networks.
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tracking/pose_fit.h"
#include "tracking/tracker.h"

namespace lorgnette {
namespace {

constexpr int kWidth = 1280, kHeight = 720;
constexpr double kRate = 30;

std::string Setting(const char* name, const char* fallback) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : fallback;
}

std::vector<ImageRgb8> ReadFrames() {
  std::ifstream file(Setting("LORGNETTE_BENCH_FRAMES", ""), std::ios::binary);
  std::vector<ImageRgb8> frames;
  ImageRgb8 frame(kWidth, kHeight);
  while (
      file.read(reinterpret_cast<char*>(frame.data.data()), std::streamsize(frame.data.size()))) {
    frames.push_back(frame);
  }
  return frames;
}

// Everything from pictures to smoothed poses and expressions; frames a second.
void TrackClip(benchmark::State& state) {
  cv::setNumThreads(1);
  const std::vector<ImageRgb8> frames = ReadFrames();
  if (frames.empty()) {
    state.SkipWithError("LORGNETTE_BENCH_FRAMES: got no frame, want raw rgb24, 1280x720");
    return;
  }
  const TrackerOptions options{Setting("LORGNETTE_MODELS", "cache/models"), 64, 0};
  double residual = 0;
  for (auto _ : state) {
    auto tracker = Tracker::Create(options);
    if (!tracker) {
      state.SkipWithError(tracker.error().message.c_str());
      return;
    }
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (!tracker->Add(frames[i], double(i) / kRate)) state.SkipWithError("a frame failed");
    }
    const auto track = tracker->Finish();
    if (!track) {
      state.SkipWithError(track.error().message.c_str());
      return;
    }
    residual = double(track->frames.back().residual_px);
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t(frames.size()));
  state.counters["residual_px"] = residual;
}
BENCHMARK(TrackClip)->Name("tracking/clip/720p")->Unit(benchmark::kMillisecond);

// Calibration: a fixed amount of dense arithmetic, to compare machines by.
void Calibration(benchmark::State& state) {
  Eigen::Matrix<double, 64, 64> a = Eigen::Matrix<double, 64, 64>::Random();
  for (auto _ : state) {
    a = (a * a).eval();
    a /= a.norm();
    benchmark::DoNotOptimize(a.data());
  }
  state.SetItemsProcessed(state.iterations() * 64 * 64 * 64);
}
BENCHMARK(Calibration)->Name("tracking/calibration/matrix_64");

void FitOnePose(benchmark::State& state) {
  const Camera camera{kWidth, kHeight, 1200, 1200, 640, 360};
  Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
  truth.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal() *
                   Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  truth.translation() = Eigen::Vector3d(5, -8, 600);
  Eigen::Isometry3d guess = truth;
  guess.linear() *= Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()).toRotationMatrix();
  std::vector<PointSighting> sightings;
  for (int i = 0; i < int(state.range(0)); ++i) {
    const Eigen::Vector3d p(70 * std::sin(1.7 * i), 80 * std::sin(2.3 * i + 1),
                            20 * std::sin(3.1 * i));
    sightings.push_back({p, camera.Project(truth * p), 1});
  }
  double error_mm = 0;
  for (auto _ : state) {
    const PoseFit fit = FitPose(camera, sightings, guess, 2);
    error_mm = (fit.camera_from_head.translation() - truth.translation()).norm();
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["error_mm"] = error_mm;
  state.SetComplexityN(state.range(0));
}
BENCHMARK(FitOnePose)
    ->Name("tracking/pose_fit/points")
    ->Arg(55)
    ->Arg(110)
    ->Arg(234)
    ->Arg(468)
    ->Complexity(benchmark::oN);

}  // namespace
}  // namespace lorgnette
