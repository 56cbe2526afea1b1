// SPDX-License-Identifier: Apache-2.0
#include "validation/cost/lens_methods.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <memory>

#include "optics/media.h"
#include "optics/paraxial.h"
#include "optics/trace.h"

namespace lorgnette::validation {
namespace {

constexpr std::size_t kTile = 512;  // rays that the compositor gives to the kernel at a time

// Columns of numbers behind RayArrays.
template <typename T>
struct Columns {
  std::array<std::vector<T>, 6> c;
  explicit Columns(std::size_t n) {
    for (auto& column : c) column.resize(n);
  }
  RayArrays<T> From(std::size_t i) {
    return {&c[0][i], &c[1][i], &c[2][i], &c[3][i], &c[4][i], &c[5][i]};
  }
  RayArrays<const T> ConstFrom(std::size_t i) const {
    return {&c[0][i], &c[1][i], &c[2][i], &c[3][i], &c[4][i], &c[5][i]};
  }
  void Put(std::size_t i, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    for (std::size_t k = 0; k < 3; ++k) {
      c[k][i] = T(origin[Eigen::Index(k)]);
      c[k + 3][i] = T(direction[Eigen::Index(k)]);
    }
  }
  Eigen::Vector3d Origin(std::size_t i) const {
    return {double(c[0][i]), double(c[1][i]), double(c[2][i])};
  }
  Eigen::Vector3d Direction(std::size_t i) const {
    return {double(c[3][i]), double(c[4][i]), double(c[5][i])};
  }
};

// The rays inside the outline by the SIMD kernel, tile by tile.
template <typename T>
class Kernel {
 public:
  Kernel(const Lens& lens, double index, const CameraRays& rays)
      : lens_(lens),
        index_(index),
        rays_(rays),
        in_(rays.inside_count()),
        out_(rays.inside_count()),
        status_(rays.inside_count()) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (rays.inside(i)) in_.Put(k++, rays.origin(), rays.direction(i));
    }
  }
  void Trace() {
    for (std::size_t i = 0; i < status_.size(); i += kTile) {
      TraceLensBatch(lens_, index_, in_.ConstFrom(i), std::min(kTile, status_.size() - i),
                     {out_.From(i), &status_[i]});
    }
  }
  std::vector<ExitRay> Answer() const {
    std::vector<ExitRay> exits(rays_.size());
    std::size_t k = 0;
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (!rays_.inside(i)) continue;
      if (RayStatus(status_[k]) == RayStatus::kOk) {
        exits[i] = rays_.ExitFrom(out_.Origin(k), out_.Direction(k));
      }
      ++k;
    }
    return exits;
  }

 private:
  const Lens& lens_;
  double index_;
  const CameraRays& rays_;
  Columns<T> in_, out_;
  std::vector<std::uint8_t> status_;
};

template <typename T>
LensMethod KernelMethod(const Lens& lens, const CameraRays& rays, const char* name) {
  const auto kernel = std::make_shared<Kernel<T>>(lens, lens.medium.index_d, rays);
  return {"analytic surfaces", name, [kernel] { kernel->Trace(); },
          [kernel] {
            return LensAnswer{kernel->Answer(), {}, {}};
          }};
}

template <typename T>
LensMethod DispersedMethod(const Lens& lens, const CameraRays& rays, const char* name) {
  struct Colours {
    Kernel<T> red, design, blue;
  };
  const auto colours =
      std::make_shared<Colours>(Colours{{lens, IndexAt(lens.medium, kRed_nm), rays},
                                        {lens, lens.medium.index_d, rays},
                                        {lens, IndexAt(lens.medium, kBlue_nm), rays}});
  return {
      "analytic, three colours", name,
      [colours] {
        colours->red.Trace();
        colours->design.Trace();
        colours->blue.Trace();
      },
      [colours] {
        return LensAnswer{colours->design.Answer(), colours->red.Answer(), colours->blue.Answer()};
      }};
}

LensMethod ScalarMethod(const Lens& lens, const CameraRays& rays) {
  const auto exits = std::make_shared<std::vector<ExitRay>>(rays.size());
  return {"analytic surfaces", "double, one ray at a time",
          [exits, &lens, &rays] {
            for (std::size_t i = 0; i < rays.size(); ++i) {
              if (!rays.inside(i)) continue;
              const LensTrace trace =
                  TraceThrough(lens, {rays.origin(), rays.direction(i)}, lens.medium.index_d);
              (*exits)[i] = trace.status == RayStatus::kOk
                                ? rays.ExitFrom(trace.exit.origin, trace.exit.direction)
                                : ExitRay{};
            }
          },
          [exits] {
            return LensAnswer{*exits, {}, {}};
          }};
}

// A warp: the exit ray as a function of the camera ray's slope alone.
template <typename Warp>
LensMethod WarpMethod(const CameraRays& rays, const char* method, const char* parameter,
                      Warp warp) {
  const auto exits = std::make_shared<std::vector<ExitRay>>(rays.size());
  return {method, parameter,
          [exits, warp, &rays] {
            for (std::size_t i = 0; i < rays.size(); ++i) {
              if (rays.inside(i)) (*exits)[i] = warp(rays.slope(i));
            }
          },
          [exits] {
            return LensAnswer{*exits, {}, {}};
          }};
}

// Exact rays at every `step`-th pixel, and four numbers a pixel interpolated between them.
class DisplacementMap {
 public:
  DisplacementMap(const Lens& lens, const CameraRays& rays, int step)
      : lens_(lens),
        rays_(rays),
        step_(step),
        columns_((rays.columns() - 1) / step + 2),
        rows_((rays.rows() - 1) / step + 2),
        in_(std::size_t(columns_) * std::size_t(rows_)),
        out_(in_.c[0].size()),
        status_(in_.c[0].size()),
        nodes_(in_.c[0].size()),
        exits_(rays.size()) {
    const Eigen::Vector2d& first = rays.slope(0);
    for (int y = 0; y < rows_; ++y) {
      for (int x = 0; x < columns_; ++x) {
        const Eigen::Vector2d slope =
            first + Eigen::Vector2d(x * step, y * step) / rays.view().focal_px;
        in_.Put(Node(x, y), rays.origin(), slope.homogeneous().normalized());
      }
    }
  }
  void Trace() {
    for (std::size_t i = 0; i < status_.size(); i += kTile) {
      TraceLensBatch(lens_, lens_.medium.index_d, in_.ConstFrom(i),
                     std::min(kTile, status_.size() - i), {out_.From(i), &status_[i]});
    }
    for (std::size_t i = 0; i < status_.size(); ++i) {
      nodes_[i] = RayStatus(status_[i]) == RayStatus::kOk
                      ? rays_.ExitFrom(out_.Origin(i), out_.Direction(i))
                      : ExitRay{};
    }
    const double scale = 1.0 / step_;
    for (int y = 0; y < rays_.rows(); ++y) {
      for (int x = 0; x < rays_.columns(); ++x) {
        const std::size_t i = std::size_t(y) * std::size_t(rays_.columns()) + std::size_t(x);
        if (!rays_.inside(i)) continue;
        const int cx = x / step_, cy = y / step_;
        const double u = (x - cx * step_) * scale, v = (y - cy * step_) * scale;
        const ExitRay &a = nodes_[Node(cx, cy)], &b = nodes_[Node(cx + 1, cy)];
        const ExitRay &c = nodes_[Node(cx, cy + 1)], &d = nodes_[Node(cx + 1, cy + 1)];
        const auto mix = [&](Eigen::Vector2d ExitRay::*part) -> Eigen::Vector2d {
          return (1 - v) * ((1 - u) * a.*part + u * b.*part) +
                 v * ((1 - u) * c.*part + u * d.*part);
        };
        exits_[i] = {a.ok && b.ok && c.ok && d.ok, mix(&ExitRay::at), mix(&ExitRay::slope)};
      }
    }
  }
  const std::vector<ExitRay>& exits() const { return exits_; }

 private:
  std::size_t Node(int x, int y) const {
    return std::size_t(y) * std::size_t(columns_) + std::size_t(x);
  }
  const Lens& lens_;
  const CameraRays& rays_;
  int step_, columns_, rows_;
  Columns<double> in_, out_;
  std::vector<std::uint8_t> status_;
  std::vector<ExitRay> nodes_, exits_;
};

}  // namespace

std::vector<LensMethod> WarpMethods(const Lens& lens, const CameraRays& rays) {
  const double camera = rays.view().camera_mm, thickness = lens.center_thickness_mm;
  const AstigmaticSystem system = SystemOf(lens);
  const Eigen::Matrix2d power_per_mm = system.BackVertexPower() / 1000;
  const Eigen::Matrix2d height = camera * system.a + 1000 * system.b_m;
  const Eigen::Matrix2d slope = camera / 1000 * system.c_D + system.d;
  std::vector<LensMethod> methods;
  methods.push_back(
      WarpMethod(rays, "no lens", "", [camera, thickness](const Eigen::Vector2d& s) -> ExitRay {
        return {true, (camera + thickness) * s, s};
      }));
  methods.push_back(
      WarpMethod(rays, "thin lens", "",
                 [camera, thickness, power_per_mm](const Eigen::Vector2d& s) -> ExitRay {
                   const Eigen::Vector2d at = (camera + thickness) * s;
                   return {true, at, s - power_per_mm * at};
                 }));
  methods.push_back(WarpMethod(rays, "thick lens, to first order", "",
                               [height, slope](const Eigen::Vector2d& s) -> ExitRay {
                                 return {true, height * s, slope * s};
                               }));
  return methods;
}

std::vector<LensMethod> MapMethods(const Lens& lens, const CameraRays& rays) {
  std::vector<LensMethod> methods;
  for (int step = 32; step >= 2; step /= 2) {
    const auto map = std::make_shared<DisplacementMap>(lens, rays, step);
    methods.push_back({"displacement map", fmt::format("every {} px", step),
                       [map] { map->Trace(); },
                       [map] {
                         return LensAnswer{map->exits(), {}, {}};
                       }});
  }
  return methods;
}

std::vector<LensMethod> AnalyticMethods(const Lens& lens, const CameraRays& rays) {
  return {KernelMethod<float>(lens, rays, "float, SIMD"),
          KernelMethod<double>(lens, rays, "double, SIMD"), ScalarMethod(lens, rays),
          DispersedMethod<float>(lens, rays, "float, SIMD"),
          DispersedMethod<double>(lens, rays, "double, SIMD")};
}

}  // namespace lorgnette::validation
