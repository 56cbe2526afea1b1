// SPDX-License-Identifier: Apache-2.0
// The compositor on a 720p frame of a video (display-encoded in and out) with a face about 350
// pixels wide, everything of the paper on.
// `render/calibration/chain` is a fixed amount of arithmetic in the same process: compare with it,
// since machines are noisy.
#include <benchmark/benchmark.h>

#include <cmath>

#include "base/units.h"
#include "bench/calibration.h"
#include "geometry/assemble.h"
#include "geometry/eyewear.h"
#include "geometry/frame_io.h"
#include "optics/certify.h"
#include "optics/design.h"
#include "render/color.h"
#include "render/compositor.h"

namespace lorgnette {
namespace {

BENCHMARK(bench::Calibration)->Name("render/calibration/chain");

std::vector<Eigen::Vector2d> Outline() {
  std::vector<Eigen::Vector2d> contour;
  for (int i = 0; i < 240; ++i) {
    const double angle = 2 * kPi * i / 240;
    // Superellipse of exponent 2.6, 50 x 38 mm.
    const auto power = [](double v) { return std::copysign(std::pow(std::abs(v), 2 / 2.6), v); };
    contour.emplace_back(25 * power(std::cos(angle)), 19 * power(std::sin(angle)));
  }
  return contour;
}

CutLens MakeLens(Eye eye, double x_mm) {
  LensOrder order;
  order.eye = eye;
  order.rx.sphere = Diopters(-6);
  order.medium.index_d = 1.6;
  order.contour_mm = Outline();
  CertifiedLens lens = *Certify(*DesignLens(order));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Vector3d(-1, 1, -1).asDiagonal();
  pose.translation() = Eigen::Vector3d(x_mm, 0, lens.lens().center_thickness_mm - 1);
  return CutLens{std::move(lens), Outline(), pose, {}, 0};
}

// Half an ellipsoid for the face, rims and straight temples for the frame.
TriangleMesh Face() {
  TriangleMesh mesh;
  constexpr int kRings = 40, kSides = 80;
  for (int j = 0; j <= kRings; ++j) {
    for (int i = 0; i <= kSides; ++i) {
      const double polar = 0.55 * kPi * j / kRings, angle = 2 * kPi * i / kSides;
      mesh.positions.emplace_back(78 * std::sin(polar) * std::cos(angle),
                                  105 * std::sin(polar) * std::sin(angle) - 20,
                                  90 * std::cos(polar) - 85);
    }
  }
  for (int j = 0; j < kRings; ++j) {
    for (int i = 0; i < kSides; ++i) {
      const int a = j * (kSides + 1) + i, b = a + 1, c = a + kSides + 1, d = c + 1;
      mesh.triangles.emplace_back(a, c, d);
      mesh.triangles.emplace_back(a, d, b);
    }
  }
  return mesh;
}

TriangleMesh Rim(double x_mm) {
  TriangleMesh mesh;
  const std::vector<Eigen::Vector2d> outline = Outline();
  const int n = int(outline.size());
  constexpr int kSection = 12;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector2d along =
        (outline[std::size_t((i + 1) % n)] - outline[std::size_t((i + n - 1) % n)]).normalized();
    const Eigen::Vector2d out(along.y(), -along.x());
    for (int k = 0; k < kSection; ++k) {
      const double angle = 2 * kPi * k / kSection;
      const Eigen::Vector2d p = outline[std::size_t(i)] + (1.1 + 1.5 * std::cos(angle)) * out;
      mesh.positions.emplace_back(x_mm + p.x(), p.y(), 2 * std::sin(angle));
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < kSection; ++k) {
      const int a = i * kSection + k, b = i * kSection + (k + 1) % kSection;
      const int c = (i + 1) % n * kSection + k, d = (i + 1) % n * kSection + (k + 1) % kSection;
      mesh.triangles.emplace_back(a, c, d);
      mesh.triangles.emplace_back(a, d, b);
    }
  }
  ComputeVertexNormals(mesh);
  return mesh;
}

struct Setup {
  Eyewear eyewear{FrameModel{}, MakeLens(Eye::kRight, -32), MakeLens(Eye::kLeft, 32),
                  Eigen::Isometry3d(Eigen::Translation3d(0, 0, 14)), WearingPosition{}};
  TriangleMesh face = Face();
  Environment environment = Environment::Constant({0.8f, 0.9f, 1});
  ImageRgb8 input;
  Camera camera;
  Eigen::Isometry3d camera_from_head = Eigen::Isometry3d::Identity();

  // 16:9; the head fills the same share of a picture of any height.
  explicit Setup(int height)
      : input(height * 16 / 9, height), camera{input.width,       height,
                                               1.625 * height,    1.625 * height,
                                               0.5 * input.width, 0.5 * height} {
    FramePart part;
    part.name = "front";
    part.kind = FramePartKind::kFront;
    for (const double x : {-32.0, 32.0}) Append(part.mesh, Rim(x));
    eyewear.frame.parts.push_back(std::move(part));
    ImageRgbF map(512, 256);
    for (int y = 0; y < 256; ++y) {
      for (int x = 0; x < 512; ++x) {
        const bool lamp = std::abs(x - 190) < 14 && std::abs(y - 70) < 14;
        for (int c = 0; c < 3; ++c) map.at(x, y)[c] = lamp ? 20.0f : 1.2f - 0.004f * float(y);
      }
    }
    environment = Environment(std::move(map));
    for (int y = 0; y < input.height; ++y) {
      for (int x = 0; x < input.width; ++x) {
        for (int c = 0; c < 3; ++c) {
          input.at(x, y)[c] = CodeFromLinear(0.3f + 0.1f * std::sin(0.05f * float(x + c)) *
                                                        std::cos(0.07f * float(y)));
        }
      }
    }
    camera_from_head.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
    camera_from_head.translation() = Eigen::Vector3d(0, 0, 520);
  }
};

const Setup& TheSetup() {
  static const Setup setup(720);
  return setup;
}

// The same with a frame as it is worn and lenses cut to it: some 25,000 triangles, pads, temples.
const Setup& Worn() {
  static const Setup setup = [] {
    Setup worn(720);
    Fit fit;
    fit.frame = *LoadFrame("panto");
    fit.head_from_frame = Eigen::Translation3d(0, 0, 14);
    Prescription rx;
    for (EyePrescription* eye : {&rx.right, &rx.left}) eye->sphere = Diopters(-6);
    worn.eyewear = *MakeEyewear(fit, rx, {-32, 0, 0}, {32, 0, 0});
    return worn;
  }();
  return setup;
}

void Render(benchmark::State& state, const CompositorOptions& options,
            const Setup& setup = TheSetup()) {
  const Compositor compositor =
      *Compositor::Create(setup.eyewear, setup.face, TriangleMesh{}, setup.environment, options);
  RenderCounts counts;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        compositor.Render(setup.input, setup.camera, setup.camera_from_head, &counts));
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["lens_px"] = double(counts.lens_pixels);
  state.counters["frame_px"] = double(counts.frame_pixels);
  state.counters["shadow_px"] = double(counts.shadowed_pixels);
  // Accuracy beside speed: against full samples.
  CompositorOptions full = options;
  full.adaptive = false;
  const ImageRgb8 reference =
      Compositor::Create(setup.eyewear, setup.face, TriangleMesh{}, setup.environment, full)
          ->Render(setup.input, setup.camera, setup.camera_from_head);
  const ImageRgb8 picture = compositor.Render(setup.input, setup.camera, setup.camera_from_head);
  double sum = 0;
  for (std::size_t i = 0; i < picture.data.size(); ++i) {
    sum += std::pow(double(picture.data[i]) - double(reference.data[i]), 2);
  }
  if (sum > 0) {
    state.counters["psnr_to_full_dB"] =
        10 * std::log10(255.0 * 255.0 * double(picture.data.size()) / sum);
  }
}

CompositorOptions Adaptive() {
  CompositorOptions options;
  options.adaptive = true;
  return options;
}
CompositorOptions Paper() {
  CompositorOptions options;
  options.shadow = ShadowMode::kPaper;
  return options;
}

// Wall and processor time in ms.
void Timed(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
}

void BM_Full(benchmark::State& state) { Render(state, CompositorOptions{}); }
BENCHMARK(BM_Full)->Name("render/compositor/full_2x2")->Apply(Timed);
void BM_FullWorn(benchmark::State& state) { Render(state, CompositorOptions{}, Worn()); }
BENCHMARK(BM_FullWorn)->Name("render/compositor/full_2x2/panto")->Apply(Timed);

void BM_Adaptive(benchmark::State& state) { Render(state, Adaptive()); }
BENCHMARK(BM_Adaptive)->Name("render/compositor/adaptive")->Apply(Timed);
void BM_AdaptiveWorn(benchmark::State& state) { Render(state, Adaptive(), Worn()); }
BENCHMARK(BM_AdaptiveWorn)->Name("render/compositor/adaptive/panto")->Apply(Timed);

void BM_Paper(benchmark::State& state) { Render(state, Paper()); }
BENCHMARK(BM_Paper)->Name("render/compositor/paper_160")->Apply(Timed);
void BM_PaperWorn(benchmark::State& state) { Render(state, Paper(), Worn()); }
BENCHMARK(BM_PaperWorn)->Name("render/compositor/paper_160/panto")->Apply(Timed);

// Growth with the pixels of the frame.
void BM_Growth(benchmark::State& state) {
  const Setup setup(int(state.range(0)));
  Render(state, Adaptive(), setup);
  state.SetComplexityN(std::int64_t(setup.input.width) * setup.input.height);
}
BENCHMARK(BM_Growth)
    ->Name("render/compositor/adaptive/height")
    ->Arg(360)
    ->Arg(720)
    ->Arg(1440)
    ->Apply(Timed)
    ->Complexity(benchmark::oN);

// Scene, trees and baked light, by the directions baked for a point of the face.
void BM_Create(benchmark::State& state) {
  const Setup& setup = TheSetup();
  CompositorOptions options;
  options.shadow_directions = int(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        Compositor::Create(setup.eyewear, setup.face, TriangleMesh{}, setup.environment, options));
  }
  state.SetComplexityN(state.range(0));
}
BENCHMARK(BM_Create)
    ->Name("render/compositor/create_and_bake/directions")
    ->Arg(256)
    ->Arg(512)
    ->Arg(1024)
    ->Arg(2048)
    ->Apply(Timed)
    ->Complexity(benchmark::oN);

void BM_CreateWorn(benchmark::State& state) {
  const Setup& setup = Worn();
  std::size_t triangles = 0;
  for (const FramePart& part : setup.eyewear.frame.parts) triangles += part.mesh.triangles.size();
  for (auto _ : state) {
    benchmark::DoNotOptimize(Compositor::Create(setup.eyewear, setup.face, TriangleMesh{},
                                                setup.environment, CompositorOptions{}));
  }
  state.counters["frame_triangles"] = double(triangles);
}
BENCHMARK(BM_CreateWorn)->Name("render/compositor/create_and_bake/panto")->Apply(Timed);

}  // namespace
}  // namespace lorgnette
