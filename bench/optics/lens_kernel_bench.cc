// SPDX-License-Identifier: Apache-2.0
// Speed of rays through a lens, with its accuracy as a counter, beside a calibration kernel.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "optics/lens_kernel.h"
#include "optics/trace.h"
#include "tests/optics/lens_oracle.h"

namespace lorgnette {
namespace {

constexpr std::size_t kRays = 512;  // a tile of the renderer; stays in the first-level cache
constexpr double kIndex = 1.6;

Lens SpherePair() {
  Lens lens;
  lens.front = Surface(SphereSurface{1 / 300.0});
  lens.back = Surface(SphereSurface{1 / 74.9647941931});
  lens.center_thickness_mm = 1.5;
  return lens;
}

Lens ToricBack() {
  Lens lens = SpherePair();
  lens.back = Surface(TorusSurface{1 / 54.47, 1 / 74.86, 2.1});
  return lens;
}

Lens AsphericFront() {
  Lens lens = SpherePair();
  ConicSurface conic;
  conic.curvature = 1 / 70.0;
  conic.conic = -0.8;
  conic.even = {-4e-7, 1e-10, 0, 0};
  lens.front = Surface(conic);
  return lens;
}

Lens ProgressiveFront() {
  Lens lens = SpherePair();
  lens.front = Surface(ProgressiveSurface(5.0 / 600, 2.0 / 600, 0, 14));
  return lens;
}

// A sphere with a ripple on 61 x 61 nodes, as a soft progressive or a measured surface has them.
Lens GridFront() {
  constexpr int kNodes = 61;
  Eigen::MatrixXd sag(kNodes, kNodes);
  for (int i = 0; i < kNodes; ++i) {
    for (int j = 0; j < kNodes; ++j) {
      const double x = i - 30.0, y = j - 30.0;
      sag(i, j) = Surface(SphereSurface{5.0 / 600}).Jet(x, y)->z +
                  0.02 * (1 - std::cos(x / 8)) * std::cos(y / 11);
    }
  }
  Lens lens = SpherePair();
  lens.front = Surface(GridSurface{
      std::make_shared<SplineGrid>(SplineGrid::Through(sag, -30, -30, 1, 1, 5.0 / 600))});
  return lens;
}

Lens AtoroidBack() {
  Lens lens = SpherePair();
  AtoroidSurface s;
  s.curvature_generator = 1 / 54.47;
  s.curvature_across = 1 / 74.86;
  s.conic_across = -0.7;
  s.a4_generator = 2e-7;
  s.generator_angle = 2.1;
  lens.back = Surface(s);
  return lens;
}

// Camera rays from 500 mm to points up to 25 mm off the axis.
template <typename T>
struct Rays {
  std::vector<T> in[6], out[6];
  std::vector<std::uint8_t> status;
  explicit Rays(std::size_t count = kRays) : status(count) {
    for (int k = 0; k < 6; ++k) {
      in[k].resize(count);
      out[k].resize(count);
    }
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    for (std::size_t i = 0; i < count; ++i) {
      const double r = 25 * std::sqrt(unit(random)), a = 6.283185307 * unit(random);
      const Eigen::Vector3d d = Eigen::Vector3d(r * std::cos(a), r * std::sin(a), 500).normalized();
      const double values[] = {0, 0, -500, d.x(), d.y(), d.z()};
      for (int k = 0; k < 6; ++k) in[k][i] = T(values[k]);
    }
  }
  RayArrays<const T> Input() const {
    return {in[0].data(), in[1].data(), in[2].data(), in[3].data(), in[4].data(), in[5].data()};
  }
  RayArrays<T> Output() {
    return {out[0].data(), out[1].data(), out[2].data(),
            out[3].data(), out[4].data(), out[5].data()};
  }
};

// Worst error against long double: mm on the exit surface, and of the direction.
template <typename T>
void CountErrors(const Lens& lens, const Rays<T>& rays, benchmark::State& state) {
  double position = 0, direction = 0;
  for (std::size_t i = 0; i < rays.status.size(); i += 7) {
    const auto field = [&](const std::vector<T>* v, int k) {
      return oracle::Vec(v[k][i], v[k + 1][i], v[k + 2][i]);
    };
    const oracle::Vec from = field(rays.in, 0), way = field(rays.in, 3).normalized();
    oracle::Vec point, exit;
    if (std::holds_alternative<ProgressiveSurface>(lens.front.shape()) ||
        std::holds_alternative<GridSurface>(lens.front.shape()) ||
        std::holds_alternative<AtoroidSurface>(lens.back.shape())) {
      // No long double form: the scalar path, good to 1e-14 mm.
      const LensTrace scalar =
          TraceThrough(lens, {from.cast<double>(), way.cast<double>()}, static_cast<T>(kIndex));
      point = scalar.exit.origin.cast<oracle::Real>();
      exit = scalar.exit.direction.cast<oracle::Real>();
    } else {
      const auto expected = oracle::TraceLens(lens, from, way, static_cast<T>(kIndex));
      point = expected.second.point;
      exit = expected.exit;
    }
    position = std::max(position, double((field(rays.out, 0) - point).norm()));
    direction = std::max(direction, double((field(rays.out, 3) - exit).norm()));
  }
  state.counters["err_mm"] = position;
  state.counters["err_dir"] = direction;
}

template <typename T>
void TraceBatch(benchmark::State& state, const Lens& lens, std::size_t count = kRays) {
  Rays<T> rays(count);
  for (auto _ : state) {
    TraceLensBatch(lens, kIndex, rays.Input(), count, {rays.Output(), rays.status.data()});
    benchmark::DoNotOptimize(rays.out[0].data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t(count));
  state.SetLabel(LensKernelTarget());
  CountErrors(lens, rays, state);
}

void TraceScalar(benchmark::State& state, const Lens& lens) {
  Rays<double> rays;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kRays; ++i) {
      const Ray ray{{rays.in[0][i], rays.in[1][i], rays.in[2][i]},
                    {rays.in[3][i], rays.in[4][i], rays.in[5][i]}};
      const LensTrace trace = TraceThrough(lens, ray, kIndex);
      for (int k = 0; k < 3; ++k) {
        rays.out[k][i] = trace.exit.origin[k];
        rays.out[k + 3][i] = trace.exit.direction[k];
      }
    }
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t(kRays));
  CountErrors(lens, rays, state);
}

// Square roots and divisions as a two-sphere trace needs them, and nothing else: what the machine
// gives today. Compare times with this one, not with the clock.
template <typename T>
void Calibration(benchmark::State& state) {
  using Array = Eigen::Array<T, Eigen::Dynamic, 1>;
  Array a = Array::LinSpaced(Eigen::Index(kRays), T(1), T(2)), b = a;
  for (auto _ : state) {
    for (int i = 0; i < 2; ++i) b = (a + (a * b).sqrt() + (b + T(1)).sqrt()) / (a + b);
    benchmark::DoNotOptimize(b.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t(kRays));
}

BENCHMARK(Calibration<double>)->Name("optics/calibration/double");
BENCHMARK(Calibration<float>)->Name("optics/calibration/float");
void SpherePairDouble(benchmark::State& state) { TraceBatch<double>(state, SpherePair()); }
void SpherePairFloat(benchmark::State& state) { TraceBatch<float>(state, SpherePair()); }
void SpherePairScalar(benchmark::State& state) { TraceScalar(state, SpherePair()); }
void TorusDouble(benchmark::State& state) { TraceBatch<double>(state, ToricBack()); }
void TorusFloat(benchmark::State& state) { TraceBatch<float>(state, ToricBack()); }
void TorusScalar(benchmark::State& state) { TraceScalar(state, ToricBack()); }
void AsphereDouble(benchmark::State& state) { TraceBatch<double>(state, AsphericFront()); }
void AsphereFloat(benchmark::State& state) { TraceBatch<float>(state, AsphericFront()); }
void ProgressiveDouble(benchmark::State& state) { TraceBatch<double>(state, ProgressiveFront()); }
void ProgressiveFloat(benchmark::State& state) { TraceBatch<float>(state, ProgressiveFront()); }
void ProgressiveScalar(benchmark::State& state) { TraceScalar(state, ProgressiveFront()); }
void AtoroidDouble(benchmark::State& state) { TraceBatch<double>(state, AtoroidBack()); }
void AtoroidFloat(benchmark::State& state) { TraceBatch<float>(state, AtoroidBack()); }
void GridDouble(benchmark::State& state) { TraceBatch<double>(state, GridFront()); }
void GridFloat(benchmark::State& state) { TraceBatch<float>(state, GridFront()); }
void GridScalar(benchmark::State& state) { TraceScalar(state, GridFront()); }
// Growth with the number of rays, from what the first-level cache holds to what it does not.
void SpherePairGrowth(benchmark::State& state) {
  TraceBatch<double>(state, SpherePair(), std::size_t(state.range(0)));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(SpherePairGrowth)
    ->Name("optics/trace/sphere_pair/double/rays")
    ->RangeMultiplier(8)
    ->Range(64, 1 << 15)
    ->Complexity(benchmark::oN);
BENCHMARK(SpherePairDouble)->Name("optics/trace/sphere_pair/double");
BENCHMARK(SpherePairFloat)->Name("optics/trace/sphere_pair/float");
BENCHMARK(SpherePairScalar)->Name("optics/trace/sphere_pair/scalar");
BENCHMARK(TorusDouble)->Name("optics/trace/torus/double");
BENCHMARK(TorusFloat)->Name("optics/trace/torus/float");
BENCHMARK(TorusScalar)->Name("optics/trace/torus/scalar");
BENCHMARK(AsphereDouble)->Name("optics/trace/asphere/double");
BENCHMARK(AsphereFloat)->Name("optics/trace/asphere/float");
BENCHMARK(ProgressiveDouble)->Name("optics/trace/progressive/double");
BENCHMARK(ProgressiveFloat)->Name("optics/trace/progressive/float");
BENCHMARK(ProgressiveScalar)->Name("optics/trace/progressive/scalar");
BENCHMARK(AtoroidDouble)->Name("optics/trace/atoroid/double");
BENCHMARK(AtoroidFloat)->Name("optics/trace/atoroid/float");
BENCHMARK(GridDouble)->Name("optics/trace/grid/double");
BENCHMARK(GridFloat)->Name("optics/trace/grid/float");
BENCHMARK(GridScalar)->Name("optics/trace/grid/scalar");

}  // namespace
}  // namespace lorgnette
