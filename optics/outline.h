// SPDX-License-Identifier: Apache-2.0
// The outline to which a lens will be cut, as spokes from its optical centre: what least edge
// thickness and weight are computed over.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

#include "optics/lens.h"

namespace lorgnette {

// A value of some function on a rim, and where.
struct RimValue {
  double value = 0;
  Eigen::Vector2d at{0, 0};
};

class Outline {
 public:
  // Closed polygon in the lens frame's x, y, either orientation, at least three points; edges are
  // subdivided to kMaxSpacing_mm.
  static Outline FromPolygon(const std::vector<Eigen::Vector2d>& contour_mm);
  static Outline Round(double diameter_mm);

  // Points on the outline.
  const std::vector<Eigen::Vector2d>& rim() const { return rim_; }
  double radius_mm() const { return radius_mm_; }  // farthest rim point from the optical centre
  // Between the points: `at` counts them, fractions run along the circle or the polygon's edge.
  Eigen::Vector2d RimAt(double at) const;

  // Least value of f(x, y) on the rim: over its points, then by golden sections between the two
  // neighbours of the least. nullopt where f has no value at a point.
  template <typename F>
  std::optional<RimValue> LeastOnRim(F&& f) const;

  // Integral over the area of f(x, y), by Gauss-Legendre along each spoke. Exact in angle for a
  // circle to rounding, and for a polygon to the order of the rule.
  template <typename F>
  double Integrate(F&& f) const {
    double sum = 0;
    for (const Spoke& spoke : spokes_) {
      double along = 0;
      for (int i = 0; i < kGaussPoints; ++i) {
        const double r = GaussPoint(i);
        along += GaussWeight(i) * r * f(r * spoke.end.x(), r * spoke.end.y());
      }
      sum += spoke.weight * along;
    }
    return sum;
  }

  static constexpr double kMaxSpacing_mm = 1.0;
  static constexpr int kCircleSpokes = 180;

 private:
  static constexpr int kGaussPoints = 10;
  static double GaussPoint(int i);   // on [0, 1]
  static double GaussWeight(int i);  // summing to 1

  struct Spoke {
    Eigen::Vector2d end;
    double weight;  // signed: a spoke of an outline beyond the optical centre counts backward
  };
  std::vector<Eigen::Vector2d> rim_;
  std::vector<Spoke> spokes_;
  double radius_mm_ = 0;
  bool round_ = false;
};

template <typename F>
std::optional<RimValue> Outline::LeastOnRim(F&& f) const {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSections = 40;  // 2 points apart, then 1e-8 of that: the value is flat there
  std::optional<RimValue> least;
  double i_least = 0;
  for (std::size_t i = 0; i < rim_.size(); ++i) {
    const std::optional<double> value = f(rim_[i].x(), rim_[i].y());
    if (!value) return std::nullopt;
    if (least && !(*value < least->value)) continue;
    least = RimValue{*value, rim_[i]};
    i_least = double(i);
  }
  const auto try_at = [&](double i) {
    const Eigen::Vector2d p = RimAt(i);
    const std::optional<double> value = f(p.x(), p.y());
    if (value && *value < least->value) least = RimValue{*value, p};
    return value ? *value : HUGE_VAL;
  };
  double low = i_least - 1, high = i_least + 1;
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  double fa = try_at(a), fb = try_at(b);
  for (int k = 0; k < kSections; ++k) {
    if (fa < fb) {
      high = b;
      b = a;
      fb = fa;
      a = high - kGolden * (high - low);
      fa = try_at(a);
    } else {
      low = a;
      a = b;
      fa = fb;
      b = low + kGolden * (high - low);
      fb = try_at(b);
    }
  }
  return least;
}

// Distance along the axis from the front to the back surface over (x, y) of the lens frame;
// negative where they have crossed, nullopt where one of them has ended.
std::optional<double> AxialThickness(const Lens& lens, double x, double y);

// Extremes between the outline's points too, to rounding.
struct EdgeThickness {
  double least_mm = 0, greatest_mm = 0;
  double least_inside_mm = 0;  // over the rim and seven rings inside it
  Eigen::Vector2d least_at{0, 0}, greatest_at{0, 0};
};
// nullopt where a surface does not reach the rim.
std::optional<EdgeThickness> EdgeOver(const Lens& lens, const Outline& outline);

// Thickness along the rim, in the order of outline.rim(): the profile that a bevel follows. Empty
// where a surface does not reach it.
struct EdgePoint {
  Eigen::Vector2d at{0, 0};
  double front_z_mm = 0, thickness_mm = 0;
};
std::vector<EdgePoint> EdgeProfile(const Lens& lens, const Outline& outline);

// For a lens that reaches its rim, in grams.
double MassOver(const Lens& lens, const Outline& outline);

}  // namespace lorgnette
