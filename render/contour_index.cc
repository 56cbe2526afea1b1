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
  IndexEdges();
  MeasureDistances();
}

void ContourIndex::IndexEdges() {
  const std::size_t n = polygon_.size();
  // A line that runs along a cell's border may find the edge on the other side of it.
  const double margin = 1e-6 * cell_;
  const auto for_cells = [&](auto&& visit) {
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector2d &a = polygon_[i], &b = polygon_[(i + 1) % n];
      const auto cell = [&](double v, int k, int count) {
        return std::clamp(int((v - grid_low_[k]) * inverse_cell_), 0, count - 1);
      };
      const Eigen::Vector2d low = a.cwiseMin(b), high = a.cwiseMax(b);
      for (int row = cell(low.y() - margin, 1, rows_); row <= cell(high.y() + margin, 1, rows_);
           ++row) {
        for (int column = cell(low.x() - margin, 0, columns_);
             column <= cell(high.x() + margin, 0, columns_); ++column) {
          visit(std::size_t(row) * std::size_t(columns_) + std::size_t(column), std::uint32_t(i));
        }
      }
    }
  };
  cell_first_.assign(std::size_t(columns_) * std::size_t(rows_) + 1, 0);
  for_cells([&](std::size_t cell, std::uint32_t) { ++cell_first_[cell + 1]; });
  for (std::size_t i = 1; i < cell_first_.size(); ++i) cell_first_[i] += cell_first_[i - 1];
  cell_edges_.resize(cell_first_.back());
  std::vector<std::uint32_t> next(cell_first_.begin(), cell_first_.end() - 1);
  for_cells([&](std::size_t cell, std::uint32_t edge) { cell_edges_[next[cell]++] = edge; });
}

void ContourIndex::MeasureDistances() {
  constexpr double kRounding = 1 + 1e-9;
  // Circles around edges and around runs of them, most of which lie farther off than the nearest
  // edge found so far.
  struct Circle {
    Eigen::Vector2d centre{0, 0};
    double radius = 0;
    bool Reaches(const Eigen::Vector2d& p, double distance) const {
      const double farthest = radius + distance;
      return (centre - p).squaredNorm() < farthest * farthest;
    }
  };
  const std::size_t n = polygon_.size();
  // Around the points from the first to the last, which may be past the end.
  const auto around = [&](std::size_t first, std::size_t last) {
    Circle circle;
    for (std::size_t i = first; i <= last; ++i) circle.centre += polygon_[i % n];
    circle.centre /= double(last - first + 1);
    for (std::size_t i = first; i <= last; ++i) {
      circle.radius = std::max(circle.radius, (polygon_[i % n] - circle.centre).norm());
    }
    circle.radius *= kRounding;
    return circle;
  };
  std::vector<Circle> edges, runs;
  for (std::size_t i = 0; i < n; ++i) edges.push_back(around(i, i + 1));
  for (std::size_t i = 0; i < n; i += kRunEdges) {
    runs.push_back(around(i, std::min(i + kRunEdges, n)));
  }
  std::size_t likely = 0;  // the run that was nearest to the cell before
  std::vector<double> crossings;
  for (int row = 0; row < rows_; ++row) {
    const double y = grid_low_.y() + cell_ * (row + 0.5);
    crossings.clear();
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector2d &a = polygon_[i], &b = polygon_[(i + 1) % n];
      if ((a.y() > y) == (b.y() > y)) continue;
      crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (int column = 0; column < columns_; ++column) {
      const Eigen::Vector2d centre(grid_low_.x() + cell_ * (column + 0.5), y);
      // No farther than from the cell before and on to this one.
      nearest = (nearest + cell_) * kRounding;
      const std::size_t start = likely;
      for (std::size_t k = 0; k < runs.size(); ++k) {
        const std::size_t at = (start + k) % runs.size();
        if (!runs[at].Reaches(centre, nearest)) continue;
        for (std::size_t i = at * kRunEdges; i < std::min((at + 1) * kRunEdges, n); ++i) {
          if (!edges[i].Reaches(centre, nearest)) continue;
          const double d2 = SquaredDistanceToSegment(centre, polygon_[i], polygon_[(i + 1) % n]);
          if (d2 >= nearest * nearest) continue;
          nearest = std::sqrt(d2);
          likely = at;
        }
      }
      const auto to_the_left = std::count_if(crossings.begin(), crossings.end(),
                                             [&](double x) { return x > centre.x(); });
      distance_.push_back(float((to_the_left % 2 != 0 ? 1 : -1) * nearest));
    }
  }
}

bool ContourIndex::InGrid(double x, double y) const {
  return x >= grid_low_.x() && y >= grid_low_.y() && x < grid_low_.x() + cell_ * columns_ &&
         y < grid_low_.y() + cell_ * rows_;
}

std::size_t ContourIndex::CellOf(double x, double y) const {
  const int column = std::clamp(int((x - grid_low_.x()) * inverse_cell_), 0, columns_ - 1);
  const int row = std::clamp(int((y - grid_low_.y()) * inverse_cell_), 0, rows_ - 1);
  return std::size_t(row) * std::size_t(columns_) + std::size_t(column);
}

bool ContourIndex::Contains(double x, double y) const { return Locate(x, y).inside; }

ContourIndex::Place ContourIndex::Locate(double x, double y) const {
  if (!(x >= low_.x() && x <= high_.x() && y >= low_.y() && y <= high_.y())) {
    return {false, Clearance(x, y)};
  }
  const std::size_t cell = CellOf(x, y);
  const double centre = double(distance_[cell]);
  const bool inside = std::abs(centre) > half_diagonal_ ? centre > 0 : InsideInCell(cell, x, y);
  return {inside, centre - half_diagonal_};
}

bool ContourIndex::CrossingsAreOdd(double x, double y) const {
  bool odd = false;
  for (std::size_t i = 0; i < polygon_.size(); ++i) {
    const Eigen::Vector2d &a = polygon_[i], &b = polygon_[(i + 1) % polygon_.size()];
    if ((a.y() > y) == (b.y() > y)) continue;
    if (x < a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) odd = !odd;
  }
  return odd;
}

bool ContourIndex::InsideInCell(std::size_t cell, double x, double y) const {
  const std::size_t columns = std::size_t(columns_), row = cell / columns;
  const Eigen::Vector2d centre =
      grid_low_ + cell_ * Eigen::Vector2d(double(cell - row * columns) + 0.5, double(row) + 0.5);
  const Eigen::Vector2d way = Eigen::Vector2d(x, y) - centre;
  bool inside = distance_[cell] > 0;
  // A centre on the boundary itself tells nothing.
  if (std::abs(double(distance_[cell])) < 1e-6 * cell_) return CrossingsAreOdd(x, y);
  for (std::size_t k = cell_first_[cell]; k < cell_first_[cell + 1]; ++k) {
    const std::size_t i = cell_edges_[k];
    const Eigen::Vector2d& a = polygon_[i];
    const Eigen::Vector2d& b = polygon_[i + 1 == polygon_.size() ? 0 : i + 1];
    const double before = Cross(way, a - centre), after = Cross(way, b - centre);
    if ((before > 0) == (after > 0)) continue;
    // Share of the way at which the edge's line is met.
    const double across = Cross(way, b - a), along = Cross(a - centre, b - a);
    if (across > 0 ? along > 0 && along <= across : along < 0 && along >= across) inside = !inside;
  }
  return inside;
}

double ContourIndex::Clearance(double x, double y) const {
  return InGrid(x, y) ? double(distance_[CellOf(x, y)]) - half_diagonal_ : -half_diagonal_;
}

double ContourIndex::OutsideBy(double x, double y) const {
  if (InGrid(x, y)) return -double(distance_[CellOf(x, y)]) - half_diagonal_;
  const double dx = std::max({low_.x() - x, x - high_.x(), 0.0});
  const double dy = std::max({low_.y() - y, y - high_.y(), 0.0});
  return std::hypot(dx, dy);
}

std::optional<ContourIndex::Crossing> ContourIndex::FirstCrossing(const Eigen::Vector2d& p,
                                                                  const Eigen::Vector2d& d,
                                                                  double t_min,
                                                                  double t_max) const {
  const std::size_t n = polygon_.size();
  const Eigen::Vector2d inverse = d.cwiseInverse();
  // The part of the line inside the box around the polygon.
  double t = t_min, end = t_max;
  const double margin = 1e-6 * cell_;
  for (int k = 0; k < 2; ++k) {
    const double low = low_[k] - margin - p[k], high = high_[k] + margin - p[k];
    if (d[k] == 0) {
      if (low > 0 || high < 0) return std::nullopt;
      continue;
    }
    const double a = low * inverse[k], b = high * inverse[k];
    t = std::max(t, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  const double a_millimetre = 1 / d.norm(), a_cell = cell_ * a_millimetre;
  double best = t_max, best_s = 0;
  std::size_t best_edge = n;
  // From cell to cell, and past what is free of edges at once.
  while (t <= end) {
    const Eigen::Vector2d at = p + t * d;
    const std::size_t cell = CellOf(at.x(), at.y());
    const double free = std::abs(double(distance_[cell])) - half_diagonal_;
    if (free > half_diagonal_) {
      t += free * a_millimetre;
      continue;
    }
    const Eigen::Vector2i place(int(cell % std::size_t(columns_)),
                                int(cell / std::size_t(columns_)));
    double leave = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 2; ++k) {
      if (d[k] == 0) continue;
      const double border = grid_low_[k] + cell_ * (place[k] + (d[k] > 0 ? 1 : 0));
      leave = std::min(leave, (border - p[k]) * inverse[k]);
    }
    constexpr double kLeastStep = 1e-9;  // cells: past a border, whatever is rounded
    leave = std::max(leave, t) + kLeastStep * a_cell;
    for (std::size_t k = cell_first_[cell]; k < cell_first_[cell + 1]; ++k) {
      const std::size_t i = cell_edges_[k], j = i + 1 == n ? 0 : i + 1;
      const double before = Cross(d, polygon_[i] - p), after = Cross(d, polygon_[j] - p);
      if ((before > 0) == (after > 0)) continue;
      const double s = before / (before - after);
      const Eigen::Vector2d crossing = polygon_[i] + s * (polygon_[j] - polygon_[i]);
      const double met = (crossing - p).dot(d) * (a_millimetre * a_millimetre);
      if (met > t_min && met < best) {
        best = met;
        best_s = s;
        best_edge = i;
      }
    }
    if (best <= leave) break;
    t = leave;
  }
  if (best_edge == n) return std::nullopt;
  const std::size_t next = best_edge + 1 == n ? 0 : best_edge + 1;
  return Crossing{
      best,
      ((1 - best_s) * vertex_normals_[best_edge] + best_s * vertex_normals_[next]).normalized()};
}

}  // namespace lorgnette
