// SPDX-License-Identifier: Apache-2.0
// The outline to which a lens will be cut, as spokes from its optical centre: what least edge
// thickness and weight are computed over.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "optics/lens.h"

namespace lorgnette {

class Outline {
 public:
  // Closed polygon in the lens frame's x, y, either orientation, at least three points; edges are
  // subdivided to kMaxSpacing_mm.
  static Outline FromPolygon(const std::vector<Eigen::Vector2d>& contour_mm);
  static Outline Round(double diameter_mm);

  // Points on the outline.
  const std::vector<Eigen::Vector2d>& rim() const { return rim_; }
  double radius_mm() const { return radius_mm_; }  // farthest rim point from the optical centre

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
};

// Distance along the axis from the front to the back surface over (x, y) of the lens frame;
// negative where they have crossed, nullopt where one of them has ended.
std::optional<double> AxialThickness(const Lens& lens, double x, double y);

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
