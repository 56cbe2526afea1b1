// SPDX-License-Identifier: Apache-2.0
#include "render/contour_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace lorgnette {
namespace {

constexpr int kCellsAcross = 96;  // along the longer side
constexpr int kBorderCells = 12;
constexpr std::size_t kRunEdges = 12;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double SquaredDistanceToSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                                const Eigen::Vector2d& b) {
  const Eigen::Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double s = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - s * ab).squaredNorm();
}

}  // namespace

ContourIndex::ContourIndex(std::vector<Eigen::Vector2d> polygon) : polygon_(std::move(polygon)) {
  LG_CHECK_GE(polygon_.size(), 3u);
  const std::size_t n = polygon_.size();
  double twice_area = 0;
  for (std::size_t i = 0; i < n; ++i) twice_area += Cross(polygon_[i], polygon_[(i + 1) % n]);
  if (twice_area < 0) std::reverse(polygon_.begin(), polygon_.end());

  low_ = high_ = polygon_.front();
  for (const Eigen::Vector2d& p : polygon_) {
    low_ = low_.cwiseMin(p);
    high_ = high_.cwiseMax(p);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d before = (polygon_[i] - polygon_[(i + n - 1) % n]).normalized();
    const Eigen::Vector2d after = (polygon_[(i + 1) % n] - polygon_[i]).normalized();
    const Eigen::Vector2d along = before + after;
    vertex_normals_.push_back(Eigen::Vector2d(along.y(), -along.x()).normalized());
  }

  const Eigen::Vector2d size = high_ - low_;
  cell_ = std::max(size.maxCoeff() / kCellsAcross, 1e-9);
  inverse_cell_ = 1 / cell_;
  constexpr double kRoundingOfCell = 1 + 1e-6;  // a point on a cell's border may fall beside it
  half_diagonal_ = cell_ * std::sqrt(0.5) * kRoundingOfCell;
  grid_low_ = low_ - kBorderCells * cell_ * Eigen::Vector2d::Ones();
  columns_ = int(std::ceil(size.x() / cell_)) + 2 * kBorderCells;
  rows_ = int(std::ceil(size.y() / cell_)) + 2 * kBorderCells;
  row_edges_.resize(std::size_t(rows_));
  for (std::size_t i = 0; i < n; ++i) {
    const double y0 = polygon_[i].y(), y1 = polygon_[(i + 1) % n].y();
    const int first =
        std::clamp(int((std::min(y0, y1) - grid_low_.y()) * inverse_cell_), 0, rows_ - 1);
    const int last =
        std::clamp(int((std::max(y0, y1) - grid_low_.y()) * inverse_cell_), 0, rows_ - 1);
    for (int row = first; row <= last; ++row) row_edges_[std::size_t(row)].push_back(int(i));
  }

  for (std::size_t first = 0; first < n; first += kRunEdges) {
    Run run{first, std::min(first + kRunEdges, n), Eigen::Vector2d::Zero(), 0};
    for (std::size_t i = run.first; i <= run.end; ++i) run.centre += polygon_[i % n];
    run.centre /= double(run.end - run.first + 1);
    for (std::size_t i = run.first; i <= run.end; ++i) {
      run.radius = std::max(run.radius, (polygon_[i % n] - run.centre).norm());
    }
    constexpr double kRounding = 1 + 1e-9;
    run.radius *= kRounding;
    runs_.push_back(run);
  }

  std::vector<float> distance;
  std::size_t likely = 0;  // the run that was nearest to the cell before
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const Eigen::Vector2d centre = grid_low_ + cell_ * Eigen::Vector2d(column + 0.5, row + 0.5);
      double nearest2 = std::numeric_limits<double>::infinity();
      const std::size_t start = likely;
      for (std::size_t k = 0; k < runs_.size(); ++k) {
        const std::size_t at = (start + k) % runs_.size();
        const Run& run = runs_[at];
        const double least = (run.centre - centre).norm() - run.radius;
        if (least > 0 && least * least >= nearest2) continue;
        for (std::size_t i = run.first; i < run.end; ++i) {
          const double d2 = SquaredDistanceToSegment(centre, polygon_[i], polygon_[(i + 1) % n]);
          if (d2 >= nearest2) continue;
          nearest2 = d2;
          likely = at;
        }
      }
      const double sign = Contains(centre.x(), centre.y()) ? 1 : -1;
      distance.push_back(float(sign * std::sqrt(nearest2)));
    }
  }
  distance_ = std::move(distance);
}

bool ContourIndex::InGrid(double x, double y) const {
  return x >= grid_low_.x() && y >= grid_low_.y() && x < grid_low_.x() + cell_ * columns_ &&
         y < grid_low_.y() + cell_ * rows_;
}

double ContourIndex::CentreDistance(double x, double y) const {
  const int column = std::clamp(int((x - grid_low_.x()) * inverse_cell_), 0, columns_ - 1);
  const int row = std::clamp(int((y - grid_low_.y()) * inverse_cell_), 0, rows_ - 1);
  return double(distance_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)]);
}

bool ContourIndex::Contains(double x, double y) const {
  if (!(x >= low_.x() && x <= high_.x() && y >= low_.y() && y <= high_.y())) return false;
  if (!distance_.empty()) {
    const double centre = CentreDistance(x, y);
    if (std::abs(centre) > half_diagonal_) return centre > 0;
  }
  return CrossingsAreOdd(x, y);
}

ContourIndex::Place ContourIndex::Locate(double x, double y) const {
  if (!(x >= low_.x() && x <= high_.x() && y >= low_.y() && y <= high_.y())) {
    return {false, Clearance(x, y)};
  }
  const double centre = CentreDistance(x, y);
  const bool inside = std::abs(centre) > half_diagonal_ ? centre > 0 : CrossingsAreOdd(x, y);
  return {inside, centre - half_diagonal_};
}

bool ContourIndex::CrossingsAreOdd(double x, double y) const {
  const int row = std::clamp(int((y - grid_low_.y()) * inverse_cell_), 0, rows_ - 1);
  bool odd = false;
  for (const int i : row_edges_[std::size_t(row)]) {
    const Eigen::Vector2d& a = polygon_[std::size_t(i)];
    const Eigen::Vector2d& b = polygon_[(std::size_t(i) + 1) % polygon_.size()];
    if ((a.y() > y) == (b.y() > y)) continue;
    if (x < a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) odd = !odd;
  }
  return odd;
}

double ContourIndex::Clearance(double x, double y) const {
  return InGrid(x, y) ? CentreDistance(x, y) - half_diagonal_ : -half_diagonal_;
}

double ContourIndex::OutsideBy(double x, double y) const {
  if (InGrid(x, y)) return -CentreDistance(x, y) - half_diagonal_;
  const double dx = std::max({low_.x() - x, x - high_.x(), 0.0});
  const double dy = std::max({low_.y() - y, y - high_.y(), 0.0});
  return std::hypot(dx, dy);
}

std::optional<ContourIndex::Crossing> ContourIndex::FirstCrossing(const Eigen::Vector2d& p,
                                                                  const Eigen::Vector2d& d,
                                                                  double t_min,
                                                                  double t_max) const {
  const std::size_t n = polygon_.size();
  const double length = d.norm();
  double best = t_max, best_s = 0;
  std::size_t best_edge = n;
  for (const Run& run : runs_) {
    const Eigen::Vector2d to_centre = run.centre - p;
    const double reach = run.radius * length;
    if (std::abs(Cross(d, to_centre)) > reach) continue;
    // Distances along the line, times length.
    const double middle = d.dot(to_centre) / length;
    if (middle + run.radius < t_min * length || middle - run.radius > best * length) continue;
    double before = Cross(d, polygon_[run.first] - p);
    for (std::size_t i = run.first; i < run.end; ++i) {
      const std::size_t j = i + 1 == n ? 0 : i + 1;
      const double after = Cross(d, polygon_[j] - p);
      if ((before > 0) != (after > 0)) {
        const double s = before / (before - after);
        const Eigen::Vector2d crossing = polygon_[i] + s * (polygon_[j] - polygon_[i]);
        const double t = (crossing - p).dot(d) / d.squaredNorm();
        if (t > t_min && t < best) {
          best = t;
          best_s = s;
          best_edge = i;
        }
      }
      before = after;
    }
  }
  if (best_edge == n) return std::nullopt;
  const std::size_t next = best_edge + 1 == n ? 0 : best_edge + 1;
  return Crossing{
      best,
      ((1 - best_s) * vertex_normals_[best_edge] + best_s * vertex_normals_[next]).normalized()};
}

}  // namespace lorgnette
