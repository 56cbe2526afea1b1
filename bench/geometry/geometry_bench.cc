// SPDX-License-Identifier: Apache-2.0
// Contour, cut, lens mesh, import and fit, each with what it gets right as a counter.
// `geometry/calibration/chain` is a fixed amount of arithmetic in the same process: compare with
// it, since machines are noisy.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "bench/calibration.h"
#include "geometry/closed_curve.h"
#include "geometry/contour.h"
#include "geometry/cut_lens.h"
#include "geometry/fit.h"
#include "geometry/frame_import.h"
#include "geometry/frame_io.h"
#include "geometry/mesh_check.h"
#include "optics/certify.h"
#include "optics/design.h"

namespace lorgnette {
namespace {

BENCHMARK(bench::Calibration)->Name("geometry/calibration/chain");

const FrameModel& Rectangle() {
  static const FrameModel kFrame = *LoadFrame("rectangle");
  return kFrame;
}

// Both openings of a front of 50,000 triangles; error: greatest distance to the true contour.
void BM_Contour(benchmark::State& state) {
  const FrameModel& frame = Rectangle();
  const TriangleMesh front = PartsOfKind(frame, FramePartKind::kFront);
  TracedOpenings traced;
  for (auto _ : state) traced = *TraceOpenings(front);
  double worst = 0;
  for (const Eigen::Vector2d& p : traced.left.contour_mm) {
    worst = std::max(worst, DistanceToBoundary(frame.left.contour_mm, p));
  }
  state.SetItemsProcessed(state.iterations() * 2);
  state.counters["error_um"] = 1000 * worst;
  state.counters["triangles"] = double(front.triangles.size());
}
BENCHMARK(BM_Contour)->Name("geometry/contour/rectangle")->Unit(benchmark::kMillisecond);

CertifiedLens Lens(double sphere, const std::vector<Eigen::Vector2d>& contour) {
  LensOrder order;
  order.rx.sphere = Diopters(sphere);
  order.medium.index_d = 1.6;
  order.contour_mm = contour;
  return *Certify(*DesignLens(order));
}

// Cutting and mounting with the mesh at the given element size; what is left of the volume's closed
// form on a round lens in parts per million.
void BM_Cut(benchmark::State& state) {
  LensOpening opening;
  for (int k = 0; k < 720; ++k) {
    const double a = 2 * M_PI * k / 720;
    opening.contour_mm.emplace_back(25 * std::cos(a), 25 * std::sin(a));
  }
  const CertifiedLens lens = Lens(-4, ContourInLensFrame(opening.contour_mm, {0, 0}));
  CutOptions options;
  options.edge = EdgeForm::kFlat;
  options.element_mm = 0.1 * double(state.range(0));
  options.edge_points = int(540 / options.element_mm);
  TriangleMesh mesh;
  for (auto _ : state) mesh = CutAndMount(lens, opening, {0, 0}, options)->mesh;
  // Cylinder between the vertex planes, less what the front takes away, plus what the back adds.
  const auto under = [](double c) {
    const double r = 25, z = c * r * r / (1 + std::sqrt(1 - c * c * r * r));
    return c == 0 ? 0.0 : M_PI * r * r * z - M_PI * z * z * (1 / c - z / 3);
  };
  const double front = std::get<SphereSurface>(lens.lens().front.shape()).curvature;
  const double back = std::get<SphereSurface>(lens.lens().back.shape()).curvature;
  const double truth = M_PI * 625 * lens.lens().center_thickness_mm - under(front) + under(back);
  state.counters["volume_error_ppm"] =
      1e6 * std::abs(CheckMesh(mesh, false).volume_mm3 / truth - 1);
  state.counters["triangles"] = double(mesh.triangles.size());
  state.SetItemsProcessed(state.iterations() * std::int64_t(mesh.triangles.size()));
  state.SetComplexityN(std::int64_t(mesh.triangles.size()));
}
BENCHMARK(BM_Cut)
    ->Name("geometry/cut/element_tenths")
    ->Arg(30)
    ->Arg(15)
    ->Arg(5)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

// One of our frames as a model file would bring it: axes, rims, repair, temples; error of A.
void BM_Import(benchmark::State& state) {
  ModelFile model;
  for (const FramePart& part : Rectangle().parts) {
    model.parts.push_back({part.name, part.mesh, part.material, false});
  }
  FrameModel frame;
  for (auto _ : state) frame = *ImportFrame(model, "bench", 1.0);
  state.counters["error_um"] = 1000 * std::abs(frame.boxing.a_mm - Rectangle().boxing.a_mm);
}
BENCHMARK(BM_Import)->Name("geometry/import/rectangle")->Unit(benchmark::kMillisecond);

// A face of our own: a wide cylinder and a straight nose.
TriangleMesh Face() {
  TriangleMesh mesh;
  constexpr int kColumns = 141, kRows = 121;
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const double x = i - 70, y = j - 70;
      const double ridge = 10 - 0.55 * std::min(y - 8, 0.0) + 0.25 * std::max(y - 8, 0.0);
      const double nose = ridge - (1.9 + 0.012 * std::min(y, 0.0)) * (std::sqrt(x * x + 9) - 3);
      mesh.positions.emplace_back(x, y, std::max(-x * x / 110, nose));
    }
  }
  for (int j = 0; j + 1 < kRows; ++j) {
    for (int i = 0; i + 1 < kColumns; ++i) {
      const int a = j * kColumns + i;
      mesh.triangles.emplace_back(a, a + 1, a + kColumns);
      mesh.triangles.emplace_back(a + 1, a + kColumns + 1, a + kColumns);
    }
  }
  return mesh;
}

void BM_Fit(benchmark::State& state, const char* name) {
  const FrameModel frame = *LoadFrame(name);
  const TriangleMesh face = Face();
  Fit fit;
  for (auto _ : state) fit = *PlaceOnFace(frame, face, {-32, 0, 0}, {32, 0, 0});
  state.counters["penetration_um"] = 1000 * fit.wearing.nose_penetration_mm;
  state.counters["gap_um"] = 1000 * fit.wearing.nose_gap_mm;
  state.counters["vertex_mm"] = fit.wearing.vertex_distance_right_mm;
}
BENCHMARK_CAPTURE(BM_Fit, acetate, "rectangle")
    ->Name("geometry/fit/acetate")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_Fit, wire, "aviator")
    ->Name("geometry/fit/wire")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lorgnette
