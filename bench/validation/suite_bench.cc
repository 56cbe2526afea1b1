// SPDX-License-Identifier: Apache-2.0
// How long the quick part of the validation suite takes, group by group; the number of failed cases
// stands beside it as the accuracy.
#include <benchmark/benchmark.h>

#include <cmath>

#include "bench/calibration.h"
#include "validation/dot_grid.h"
#include "validation/suite.h"

namespace lorgnette::validation {
namespace {

BENCHMARK(bench::Calibration)->Name("validation/calibration/chain");

void Group(benchmark::State& state, const char* group) {
  SuiteResult result;
  for (auto _ : state) result = *RunSuite("", group);
  state.SetItemsProcessed(state.iterations() * std::int64_t(result.cases.size()));
  state.counters["failed"] = result.failed;
}
void Paraxial(benchmark::State& state) { Group(state, "paraxial"); }
void Hard(benchmark::State& state) { Group(state, "hard"); }
void Gaze(benchmark::State& state) { Group(state, "gaze"); }
BENCHMARK(Paraxial)->Name("validation/group/paraxial")->Unit(benchmark::kMicrosecond);
BENCHMARK(Gaze)->Name("validation/group/gaze")->Unit(benchmark::kMicrosecond);
BENCHMARK(Hard)->Name("validation/group/hard")->Unit(benchmark::kMillisecond);

// Finding the dots of a rendered grid: growth with the picture's pixels.
void Dots(benchmark::State& state) {
  const int size = int(state.range(0));
  ImageRgbF image(size, size);
  constexpr double kSpacing = 18, kRadius = 2.5;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const auto wrapped = [](double v) { return v - kSpacing * std::round(v / kSpacing); };
      const double dx = wrapped(x + 0.5 - 9.3), dy = wrapped(y + 0.5 - 8.9);
      const auto light = float(std::exp(-(dx * dx + dy * dy) / (2 * kRadius * kRadius)));
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = light;
    }
  }
  std::vector<Eigen::Vector2d> dots;
  for (auto _ : state) dots = DetectDots(image, kRadius);
  double worst = 0;
  for (const Eigen::Vector2d& dot : dots) {
    if (dot.minCoeff() < 2 * kSpacing || dot.maxCoeff() > size - 2 * kSpacing) continue;
    const double dx = (dot.x() - 9.3) / kSpacing, dy = (dot.y() - 8.9) / kSpacing;
    worst = std::max(worst, kSpacing * std::hypot(dx - std::round(dx), dy - std::round(dy)));
  }
  state.counters["err_px"] = worst;
  state.counters["dots"] = double(dots.size());
  state.SetItemsProcessed(state.iterations() * std::int64_t(size) * size);
  state.SetComplexityN(std::int64_t(size) * size);
}
BENCHMARK(Dots)
    ->Name("validation/dots")
    ->RangeMultiplier(2)
    ->Range(128, 512)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

}  // namespace
}  // namespace lorgnette::validation
