// SPDX-License-Identifier: Apache-2.0
// Time of a 30-degree power map at 101 x 101 points on one core.
#include <benchmark/benchmark.h>

#include <cmath>

#include "optics/gaze.h"
#include "optics/power_map.h"

namespace lorgnette {
namespace {

Lens MapLens(bool toric) {
  Lens lens;
  lens.front = Surface(SphereSurface{2.0 / 600});
  lens.back = Surface(SphereSurface{8.00375704445836 / 600});
  if (toric) lens.back = Surface(TorusSurface{1 / 54.47, 1 / 74.86, 2.1});
  lens.center_thickness_mm = 1.5;
  lens.medium.index_d = 1.6;
  return lens;
}

void PowerMapOf(benchmark::State& state, bool toric) {
  const Lens lens = MapLens(toric);
  PowerMap map;
  for (auto _ : state) {
    map = MakePowerMap(lens, 1.6);
    benchmark::DoNotOptimize(map.points.data());
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t(map.points.size()));
  // Accuracy: the right-most point against the gaze evaluated by itself.
  const MapPoint& edge = map.at(map.size - 1, map.size / 2);
  const auto gaze = EvaluateGaze(lens, 1.6, EyePose::OnAxis(lens, 27), {RadiansFromDegrees(30), 0});
  state.counters["err_D"] = std::abs(edge.power.mean - 0.5 * gaze.vergence_D.trace());
}
void SpherePairMap(benchmark::State& state) { PowerMapOf(state, false); }
void TorusMap(benchmark::State& state) { PowerMapOf(state, true); }
BENCHMARK(SpherePairMap)->Name("optics/power_map/sphere_pair/101")->Unit(benchmark::kMillisecond);
BENCHMARK(TorusMap)->Name("optics/power_map/torus/101")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lorgnette
