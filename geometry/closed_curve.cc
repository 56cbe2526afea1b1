// SPDX-License-Identifier: Apache-2.0
#include "geometry/closed_curve.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/linear_algebra.h"

namespace lorgnette {
namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Blending functions of the uniform cubic B-spline and their derivatives by the local parameter.
Eigen::Vector4d Blend(double u) {
  const double v = 1 - u;
  return Eigen::Vector4d(v * v * v, 3 * u * u * u - 6 * u * u + 4,
                         -3 * u * u * u + 3 * u * u + 3 * u + 1, u * u * u) /
         6;
}
Eigen::Vector4d BlendDerivative(double u) {
  const double v = 1 - u;
  return Eigen::Vector4d(-v * v, 3 * u * u - 4 * u, -3 * u * u + 2 * u + 1, u * u) / 2;
}
// Second derivative: linear on each piece, used for Newton steps towards an extreme.
Eigen::Vector4d BlendSecond(double u) { return {1 - u, 3 * u - 2, 1 - 3 * u, u}; }

// Which piece holds s, and where in it.
struct Piece {
  std::size_t index;
  double u;
};
Piece Locate(double s, std::size_t n) {
  const double wrapped = (s - std::floor(s)) * double(n);
  const std::size_t index = std::min(n - 1, std::size_t(wrapped));
  return {index, wrapped - double(index)};
}

Eigen::Vector2d Combine(const Polygon2& control, std::size_t piece, const Eigen::Vector4d& w) {
  const std::size_t n = control.size();
  Eigen::Vector2d sum(0, 0);
  for (std::size_t k = 0; k < 4; ++k) sum += w[int(k)] * control[(piece + k) % n];
  return sum;
}

// Calls take(i, j, u) at n equal steps of arc length: u of the way from point i to point j.
template <typename Take>
void WalkAlong(const Polygon2& polygon, int n, const Take& take) {
  LG_CHECK_GE(polygon.size(), 3u);
  const double total = Perimeter(polygon);
  std::size_t edge = 0;
  double start = 0;
  double length = (polygon[1] - polygon[0]).norm();
  for (int i = 0; i < n; ++i) {
    const double target = total * i / n;
    while (start + length < target && edge + 1 < polygon.size()) {
      start += length;
      ++edge;
      length = (polygon[(edge + 1) % polygon.size()] - polygon[edge]).norm();
    }
    take(edge, (edge + 1) % polygon.size(), length > 0 ? (target - start) / length : 0.0);
  }
}

}  // namespace

ClosedSpline::ClosedSpline(Polygon2 control) : control_(std::move(control)) {
  LG_CHECK_GE(control_.size(), 4u);
}

Eigen::Vector2d ClosedSpline::Point(double s) const {
  const Piece piece = Locate(s, control_.size());
  return Combine(control_, piece.index, Blend(piece.u));
}

Eigen::Vector2d ClosedSpline::Derivative(double s) const {
  const Piece piece = Locate(s, control_.size());
  return double(control_.size()) * Combine(control_, piece.index, BlendDerivative(piece.u));
}

Eigen::Vector2d ClosedSpline::OutwardNormal(double s) const {
  const Eigen::Vector2d d = Derivative(s);
  return Eigen::Vector2d(d.y(), -d.x()).normalized();
}

ClosedSpline ClosedSpline::FittedToBox(double a_mm, double b_mm) const {
  // Extremes of each coordinate: the derivative is quadratic on each piece; Newton from the
  // best of 16 samples a piece.
  const std::size_t n = control_.size();
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  for (std::size_t piece = 0; piece < n; ++piece) {
    for (int axis = 0; axis < 2; ++axis) {
      for (int k = 0; k <= 16; ++k) {
        double u = k / 16.0;
        for (int step = 0; step < 8; ++step) {
          const double d1 = Combine(control_, piece, BlendDerivative(u))[axis];
          const double d2 = Combine(control_, piece, BlendSecond(u))[axis];
          if (std::abs(d2) < 1e-12) break;
          u = std::clamp(u - d1 / d2, 0.0, 1.0);
        }
        const double value = Combine(control_, piece, Blend(u))[axis];
        low[axis] = std::min(low[axis], value);
        high[axis] = std::max(high[axis], value);
      }
    }
  }
  const Eigen::Vector2d centre = (low + high) / 2;
  const Eigen::Vector2d scale(a_mm / (high.x() - low.x()), b_mm / (high.y() - low.y()));
  Polygon2 moved = control_;
  for (Eigen::Vector2d& p : moved) p = (p - centre).cwiseProduct(scale);
  return ClosedSpline(std::move(moved));
}

std::vector<double> ClosedSpline::ArcLengthParameters(int n) const {
  const int fine = std::max(64 * int(control_.size()), 16 * n);
  std::vector<double> length(std::size_t(fine) + 1, 0.0);
  Eigen::Vector2d previous = Point(0);
  for (int k = 1; k <= fine; ++k) {
    const Eigen::Vector2d p = Point(double(k) / fine);
    length[std::size_t(k)] = length[std::size_t(k) - 1] + (p - previous).norm();
    previous = p;
  }
  std::vector<double> parameters(static_cast<std::size_t>(n));
  std::size_t k = 0;
  for (int i = 0; i < n; ++i) {
    const double target = length.back() * i / n;
    while (length[k + 1] < target) ++k;
    const double step = length[k + 1] - length[k];
    parameters[std::size_t(i)] = (double(k) + (step > 0 ? (target - length[k]) / step : 0)) / fine;
  }
  return parameters;
}

Polygon2 ClosedSpline::Sample(const std::vector<double>& parameters,
                              double outward_offset_mm) const {
  Polygon2 points;
  points.reserve(parameters.size());
  for (const double s : parameters) {
    points.push_back(Point(s) + outward_offset_mm * OutwardNormal(s));
  }
  return points;
}

ClosedSpline FitClosedSpline(const Polygon2& polygon, int count) {
  const int samples = int(polygon.size());
  LG_CHECK_GE(count, 4);
  LG_CHECK_GE(samples, 2 * count);
  // Normal equations of a banded periodic system, small enough to be dense.
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(count, 2);
  const Polygon2 even = Resample(polygon, samples);
  for (int i = 0; i < samples; ++i) {
    const Piece piece = Locate(double(i) / samples, std::size_t(count));
    const Eigen::Vector4d w = Blend(piece.u);
    for (int a = 0; a < 4; ++a) {
      const int row = (int(piece.index) + a) % count;
      for (int b = 0; b < 4; ++b) normal(row, (int(piece.index) + b) % count) += w[a] * w[b];
      right.row(row) += w[a] * even[std::size_t(i)].transpose();
    }
  }
  const Eigen::MatrixX2d solution = SolveSymmetric(normal, right);
  Polygon2 control(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) control[std::size_t(k)] = solution.row(k).transpose();
  return ClosedSpline(std::move(control));
}

double SignedArea(const Polygon2& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    twice += Cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  return twice / 2;
}

double Perimeter(const Polygon2& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    sum += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
  }
  return sum;
}

bool Contains(const Polygon2& polygon, const Eigen::Vector2d& point) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

double DistanceToBoundary(const Polygon2& polygon, const Eigen::Vector2d& point) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d edge = polygon[(i + 1) % polygon.size()] - a;
    const double squared = edge.squaredNorm();
    const double u = squared > 0 ? std::clamp((point - a).dot(edge) / squared, 0.0, 1.0) : 0.0;
    best = std::min(best, (point - a - u * edge).norm());
  }
  return best;
}

Polygon2 Offset(const Polygon2& polygon, double offset_mm) {
  const std::size_t n = polygon.size();
  const double side = SignedArea(polygon) >= 0 ? 1 : -1;
  Polygon2 moved(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d before = (polygon[i] - polygon[(i + n - 1) % n]).normalized();
    const Eigen::Vector2d after = (polygon[(i + 1) % n] - polygon[i]).normalized();
    const Eigen::Vector2d mean = (before + after).normalized();
    const double shrink = std::max(0.5, mean.dot(after));
    moved[i] = polygon[i] + side * offset_mm / shrink * Eigen::Vector2d(mean.y(), -mean.x());
  }
  return moved;
}

Polygon2 Resample(const Polygon2& polygon, int n) {
  Polygon2 points;
  points.reserve(std::size_t(n));
  WalkAlong(polygon, n, [&](std::size_t i, std::size_t j, double u) {
    points.push_back(polygon[i] + u * (polygon[j] - polygon[i]));
  });
  return points;
}

std::vector<double> ResampleAlong(const Polygon2& polygon, const std::vector<double>& values,
                                  int n) {
  LG_CHECK_EQ(values.size(), polygon.size());
  std::vector<double> result;
  result.reserve(std::size_t(n));
  WalkAlong(polygon, n, [&](std::size_t i, std::size_t j, double u) {
    result.push_back((1 - u) * values[i] + u * values[j]);
  });
  return result;
}

Boxing MeasureContour(const Polygon2& contour) {
  Eigen::Vector2d low = contour.front(), high = contour.front();
  for (const Eigen::Vector2d& p : contour) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector2d centre = (low + high) / 2;
  double radius = 0;
  for (const Eigen::Vector2d& p : contour) radius = std::max(radius, (p - centre).norm());
  Boxing boxing;
  boxing.a_mm = high.x() - low.x();
  boxing.b_mm = high.y() - low.y();
  boxing.effective_diameter_mm = 2 * radius;
  boxing.circumference_mm = Perimeter(contour);
  return boxing;
}

}  // namespace lorgnette
