// SPDX-License-Identifier: Apache-2.0
// Meshes: vertex normals, as they are made for every face and frame, and joining.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "base/mesh.h"
#include "base/units.h"
#include "bench/calibration.h"

namespace lorgnette {
namespace {

BENCHMARK(bench::Calibration)->Name("base/calibration/chain");

// A sphere of rings and sides, so that the normals are known.
TriangleMesh Sphere(int rings) {
  TriangleMesh mesh;
  const int sides = 2 * rings;
  for (int j = 0; j <= rings; ++j) {
    for (int i = 0; i <= sides; ++i) {
      const double polar = kPi * (j + 0.5) / (rings + 1), angle = 2 * kPi * i / sides;
      mesh.positions.emplace_back(std::sin(polar) * std::cos(angle),
                                  std::sin(polar) * std::sin(angle), std::cos(polar));
    }
  }
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < sides; ++i) {
      const int a = j * (sides + 1) + i, b = a + 1, c = a + sides + 1, d = c + 1;
      mesh.triangles.emplace_back(a, c, d);
      mesh.triangles.emplace_back(a, d, b);
    }
  }
  return mesh;
}

void VertexNormals(benchmark::State& state) {
  TriangleMesh mesh = Sphere(int(state.range(0)));
  for (auto _ : state) {
    ComputeVertexNormals(mesh);
    benchmark::DoNotOptimize(mesh.normals.data());
  }
  const auto triangles = std::int64_t(mesh.triangles.size());
  state.SetItemsProcessed(state.iterations() * triangles);
  state.SetComplexityN(triangles);
  // Accuracy: greatest angle to the sphere's own normal, away from the open poles.
  double worst = 0;
  const std::size_t row = std::size_t(2 * state.range(0) + 1);
  for (std::size_t i = row; i + row < mesh.positions.size(); ++i) {
    if (i % row == 0 || i % row == row - 1) continue;  // the seam
    worst = std::max(worst, (mesh.normals[i] - mesh.positions[i].normalized()).norm());
  }
  state.counters["err_rad"] = worst;
}
BENCHMARK(VertexNormals)
    ->Name("base/mesh/vertex_normals")
    ->RangeMultiplier(2)
    ->Range(16, 256)
    ->Complexity();

void AppendParts(benchmark::State& state) {
  const TriangleMesh part = Sphere(64);
  for (auto _ : state) {
    TriangleMesh whole;
    for (int i = 0; i < 8; ++i) Append(whole, part);
    benchmark::DoNotOptimize(whole.positions.data());
  }
  state.SetItemsProcessed(state.iterations() * 8 * std::int64_t(part.triangles.size()));
}
BENCHMARK(AppendParts)->Name("base/mesh/append/8");

}  // namespace
}  // namespace lorgnette
