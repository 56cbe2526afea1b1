// SPDX-License-Identifier: Apache-2.0
#include "optics/surface_newton.h"

#include <algorithm>
#include <cmath>

namespace lorgnette {
namespace {

constexpr int kMaxNewtonSteps = 20;
constexpr int kMaxHalvings = 6;
constexpr int kScanSteps = 128;
constexpr double kScanReach_mm = 128;  // lateral distance from the vertex that the scan covers
constexpr double kStepTolerance_mm = 4e-15;

// The ray from its point nearest the vertex, and height over the surface along it.
struct Line {
  const Surface& surface;
  Eigen::Vector3d p, d;

  std::optional<SurfaceJet> JetAt(double t) const {
    return surface.Jet(p.x() + t * d.x(), p.y() + t * d.y());
  }
  double Height(double t, const SurfaceJet& jet) const { return p.z() + t * d.z() - jet.z; }
  double Slope(const SurfaceJet& jet) const { return d.z() - jet.zx * d.x() - jet.zy * d.y(); }
};

// Newton from `t`; nullopt when it leaves the domain, stalls, or crosses against direction.z.
std::optional<double> Newton(const Line& line, double t) {
  auto jet = line.JetAt(t);
  if (!jet) return std::nullopt;
  double previous = HUGE_VAL;
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    const double slope = line.Slope(*jet);
    if (slope * line.d.z() <= 0) return std::nullopt;
    double step = -line.Height(t, *jet) / slope;
    auto next = line.JetAt(t + step);
    for (int k = 0; k < kMaxHalvings && !next; ++k) {
      step *= 0.5;
      next = line.JetAt(t + step);
    }
    if (!next) return std::nullopt;
    t += step;
    jet = next;
    const double size = std::abs(step);
    // Converged, or bouncing on the last bit: steps stop shrinking only there.
    if (size <= kStepTolerance_mm || (size < 1e-11 && size >= previous)) {
      return line.Slope(*jet) * line.d.z() > 0 ? std::optional(t) : std::nullopt;
    }
    previous = size;
  }
  return std::nullopt;
}

// First crossing in the sense of direction.z between consecutive points of a scan, by bisection.
std::optional<double> Scan(const Line& line) {
  const double lateral = std::hypot(line.d.x(), line.d.y());
  if (lateral == 0) {
    const auto jet = line.JetAt(0);
    return jet ? std::optional((jet->z - line.p.z()) / line.d.z()) : std::nullopt;
  }
  const double sense = std::copysign(1.0, line.d.z());
  // Steep rays need a short scan only: beyond the lateral reach, or past any sag, nothing is hit.
  const double reach = std::min(kScanReach_mm / lateral, 8 * kScanReach_mm);
  std::optional<double> below;
  for (int i = -kScanSteps; i <= kScanSteps; ++i) {
    const double t = reach * i / kScanSteps;
    const auto jet = line.JetAt(t);
    if (!jet) {
      below.reset();
      continue;
    }
    if (sense * line.Height(t, *jet) < 0) {
      below = t;
    } else if (below) {
      double lo = *below, hi = t;
      for (int k = 0; k < 100 && hi - lo > kStepTolerance_mm; ++k) {
        const double mid = 0.5 * (lo + hi);
        const auto m = line.JetAt(mid);
        if (!m) return std::nullopt;
        (sense * line.Height(mid, *m) < 0 ? lo : hi) = mid;
      }
      return 0.5 * (lo + hi);
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<SurfaceHit> IntersectGraph(const Surface& surface, const Ray& ray) {
  const Eigen::Vector3d& d = ray.direction;
  const double shift = -ray.origin.dot(d);
  const Line line{surface, ray.origin + shift * d, d};

  const double mean = 0.5 * surface.VertexCurvature().trace();
  const auto guess = Surface(SphereSurface{mean}).Intersect({line.p, d});
  std::optional<double> t = Newton(line, guess ? guess->distance : 0);
  if (!t) t = Scan(line);
  if (!t) return std::nullopt;

  const auto jet = line.JetAt(*t);
  if (!jet) return std::nullopt;
  SurfaceHit hit;
  hit.distance = shift + *t;
  hit.point = {line.p.x() + *t * d.x(), line.p.y() + *t * d.y(), jet->z};
  hit.normal = Eigen::Vector3d(-jet->zx, -jet->zy, 1).normalized();
  return hit;
}

}  // namespace lorgnette
