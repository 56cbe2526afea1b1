// SPDX-License-Identifier: Apache-2.0
#include "optics/outline.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/units.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

constexpr int kRings = 8;

// Positive half of the ten-point Gauss-Legendre rule on [-1, 1].
constexpr double kNodes[5] = {0.14887433898163122, 0.43339539412924719, 0.67940956829902441,
                              0.86506336668898451, 0.97390652851717172};
constexpr double kWeights[5] = {0.29552422471475287, 0.26926671930999636, 0.21908636251598204,
                                0.14945134915058059, 0.06667134430868814};

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

double Outline::GaussPoint(int i) {
  return i < 5 ? 0.5 * (1 - kNodes[4 - i]) : 0.5 * (1 + kNodes[i - 5]);
}
double Outline::GaussWeight(int i) { return 0.5 * (i < 5 ? kWeights[4 - i] : kWeights[i - 5]); }

Outline Outline::Round(double diameter_mm) {
  Outline outline;
  const double r = 0.5 * diameter_mm;
  for (int i = 0; i < kCircleSpokes; ++i) {
    const double phi = 2 * kPi * i / kCircleSpokes;
    const Eigen::Vector2d end(r * std::cos(phi), r * std::sin(phi));
    outline.rim_.push_back(end);
    outline.spokes_.push_back({end, r * r * 2 * kPi / kCircleSpokes});
  }
  outline.radius_mm_ = r;
  outline.round_ = true;
  return outline;
}

Eigen::Vector2d Outline::RimAt(double at) const {
  const double n = double(rim_.size());
  const double floor = std::floor(at), fraction = at - floor;
  if (round_) {
    const double phi = 2 * kPi * at / n;
    return radius_mm_ * Eigen::Vector2d(std::cos(phi), std::sin(phi));
  }
  const auto i = std::size_t(floor - n * std::floor(floor / n));
  return rim_[i] + fraction * (rim_[(i + 1) % rim_.size()] - rim_[i]);
}

Outline Outline::FromPolygon(const std::vector<Eigen::Vector2d>& contour_mm) {
  LG_CHECK_GE(contour_mm.size(), 3u);
  Outline outline;
  double area = 0;
  for (std::size_t i = 0; i < contour_mm.size(); ++i) {
    const Eigen::Vector2d& a = contour_mm[i];
    const Eigen::Vector2d& b = contour_mm[(i + 1) % contour_mm.size()];
    area += Cross(a, b);
    const int pieces = std::max(1, int(std::ceil((b - a).norm() / kMaxSpacing_mm)));
    for (int k = 0; k < pieces; ++k) {
      const Eigen::Vector2d p = a + (b - a) * (double(k) / pieces);
      const Eigen::Vector2d q = a + (b - a) * (double(k + 1) / pieces);
      outline.rim_.push_back(p);
      // Two-point Gauss rule across the small triangle (centre, p, q).
      for (const double s : {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)}) {
        outline.spokes_.push_back({p + s * (q - p), 0.5 * Cross(p, q)});
      }
    }
    outline.radius_mm_ = std::max(outline.radius_mm_, a.norm());
  }
  if (area < 0) {
    for (Spoke& spoke : outline.spokes_) spoke.weight = -spoke.weight;
  }
  return outline;
}

std::optional<double> AxialThickness(const Lens& lens, double x, double y) {
  const auto front = lens.front.Jet(x, y);
  if (!front) return std::nullopt;
  if (lens.back_tilt_x == 0 && lens.back_tilt_y == 0) {
    const auto back = lens.back.Jet(x, y);
    return back ? std::optional(lens.center_thickness_mm + back->z - front->z) : std::nullopt;
  }
  const auto back = IntersectBack(lens, {{x, y, 0}, {0, 0, 1}});
  return back ? std::optional(back->point.z() - front->z) : std::nullopt;
}

std::optional<EdgeThickness> EdgeOver(const Lens& lens, const Outline& outline) {
  const auto thickness = [&](double x, double y) { return AxialThickness(lens, x, y); };
  const auto thinness = [&](double x, double y) {
    const auto t = AxialThickness(lens, x, y);
    return t ? std::optional(-*t) : std::nullopt;
  };
  const auto least = outline.LeastOnRim(thickness), greatest = outline.LeastOnRim(thinness);
  if (!least || !greatest) return std::nullopt;
  EdgeThickness edge;
  edge.least_mm = edge.least_inside_mm = least->value;
  edge.least_at = least->at;
  edge.greatest_mm = -greatest->value;
  edge.greatest_at = greatest->at;
  for (const Eigen::Vector2d& p : outline.rim()) {
    for (int ring = 1; ring < kRings; ++ring) {
      const Eigen::Vector2d q = p * (double(ring) / kRings);
      const auto inside = AxialThickness(lens, q.x(), q.y());
      if (!inside) return std::nullopt;
      edge.least_inside_mm = std::min(edge.least_inside_mm, *inside);
    }
  }
  return edge;
}

std::vector<EdgePoint> EdgeProfile(const Lens& lens, const Outline& outline) {
  std::vector<EdgePoint> profile;
  for (const Eigen::Vector2d& p : outline.rim()) {
    const auto front = lens.front.Jet(p.x(), p.y());
    const auto thickness = AxialThickness(lens, p.x(), p.y());
    if (!front || !thickness) return {};
    profile.push_back({p, front->z, *thickness});
  }
  return profile;
}

double MassOver(const Lens& lens, const Outline& outline) {
  const double volume_mm3 =
      outline.Integrate([&](double x, double y) { return AxialThickness(lens, x, y).value_or(0); });
  return volume_mm3 / 1000 * lens.medium.density_g_cm3;
}

}  // namespace lorgnette
