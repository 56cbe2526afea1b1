// SPDX-License-Identifier: Apache-2.0
// Closed plane curves: the smooth outline of a lens, and polygons sampled from such curves.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/frame_model.h"

namespace lorgnette {

using Polygon2 = std::vector<Eigen::Vector2d>;  // closed, no repeated point, mm

// Uniform periodic cubic B-spline: twice continuously differentiable. Parameter s in [0, 1),
// period 1.
class ClosedSpline {
 public:
  // At least 4 control points.
  explicit ClosedSpline(Polygon2 control);

  const Polygon2& control() const { return control_; }
  Eigen::Vector2d Point(double s) const;
  Eigen::Vector2d Derivative(double s) const;
  // Unit, to the right of the direction of travel: outward on a counter-clockwise curve.
  Eigen::Vector2d OutwardNormal(double s) const;
  // Moves and scales along x and y so that the bounding box is centred and exactly a x b.
  // Tested: the extremes lie within 1e-9 mm of +-a/2, +-b/2.
  ClosedSpline FittedToBox(double a_mm, double b_mm) const;
  // n parameters at equal steps of arc length, the first being 0.
  std::vector<double> ArcLengthParameters(int n) const;
  Polygon2 Sample(const std::vector<double>& parameters, double outward_offset_mm = 0) const;

 private:
  Polygon2 control_;
};

// Control points of the spline of `count` pieces that passes nearest the given closed polygon
// (least squares at equal steps of its arc length). count >= 4 and no more than half the points.
ClosedSpline FitClosedSpline(const Polygon2& polygon, int count);

double SignedArea(const Polygon2& polygon);  // positive when counter-clockwise, mm^2
double Perimeter(const Polygon2& polygon);   // mm
bool Contains(const Polygon2& polygon, const Eigen::Vector2d& point);
// Smallest distance from a point to the polygon's boundary, mm.
double DistanceToBoundary(const Polygon2& polygon, const Eigen::Vector2d& point);
// Each vertex moved outward along the mean normal of its edges, so that edges move by offset_mm.
Polygon2 Offset(const Polygon2& polygon, double offset_mm);
// n points at equal steps of arc length along the polygon.
Polygon2 Resample(const Polygon2& polygon, int n);
// Values given at the polygon's points, at the points of Resample; linear between.
std::vector<double> ResampleAlong(const Polygon2& polygon, const std::vector<double>& values,
                                  int n);

// Boxing (ISO 8624) of one contour in its opening's plane; dbl_mm stays 0.
Boxing MeasureContour(const Polygon2& contour);

}  // namespace lorgnette
