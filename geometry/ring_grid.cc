// SPDX-License-Identifier: Apache-2.0
#include "geometry/ring_grid.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/units.h"

namespace lorgnette {
namespace {

// A stretch of a line of the grid, and whether one straight side stands for it.
struct FacetSide {
  const Eigen::Vector3d &a, &b, &normal_a, &normal_b;

  bool StandsFor(const Eigen::Vector3d& p, const Eigen::Vector3d& normal,
                 const MeshFineness& fineness) const {
    const Eigen::Vector3d along = b - a;
    const double squared = along.squaredNorm();
    const double t = squared > 0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0;
    if ((a + t * along - p).squaredNorm() > fineness.deviation_mm * fineness.deviation_mm) {
      return false;
    }
    const Eigen::Vector3d between = (1 - t) * normal_a + t * normal_b;
    return between.dot(normal) >=
           std::cos(RadiansFromDegrees(fineness.normal_deg)) * between.norm();
  }
};

}  // namespace

void RingGrid::AddRing(const std::vector<Eigen::Vector3d>& points,
                       const std::vector<Eigen::Vector3d>& normals) {
  LG_CHECK_EQ(points.size(), points_a_ring_);
  LG_CHECK_EQ(normals.size(), points_a_ring_);
  points_.insert(points_.end(), points.begin(), points.end());
  normals_.insert(normals_.end(), normals.begin(), normals.end());
}

// `at(line, k)` is the index of the k-th point of one of `lines` lines that run side by side.
// From `first` the next one kept is the farthest that every line allows; backwards where last is
// below first.
template <typename At>
void RingGrid::Keep(std::size_t first, std::size_t last, std::size_t lines, const At& at,
                    const MeshFineness& fineness, std::vector<std::size_t>& kept) const {
  const std::ptrdiff_t step = last > first ? 1 : -1;
  const auto next = [&](std::size_t k) { return std::size_t(std::ptrdiff_t(k) + step); };
  const auto stands = [&](std::size_t from, std::size_t to) {
    for (std::size_t line = 0; line < lines; ++line) {
      const std::size_t a = at(line, from), b = at(line, to);
      if ((points_[b] - points_[a]).norm() > fineness.longest_mm) return false;
      const FacetSide side{points_[a], points_[b], normals_[a], normals_[b]};
      for (std::size_t k = next(from); k != to; k = next(k)) {
        const std::size_t p = at(line, k);
        if (!side.StandsFor(points_[p], normals_[p], fineness)) return false;
      }
    }
    return true;
  };
  kept.push_back(first);
  for (std::size_t from = first; from != last;) {
    std::size_t to = next(from);
    while (to != last && stands(from, next(to))) to = next(to);
    kept.push_back(to);
    from = to;
  }
}

RingGrid RingGrid::Thinned(const MeshFineness& fineness, bool closed) const {
  const std::size_t count = rings(), n = points_a_ring_;
  std::vector<std::size_t> rows, columns;
  const auto along = [&](std::size_t column, std::size_t row) { return row % count * n + column; };
  if (closed) {
    Keep(0, count, n, along, fineness, rows);
    rows.pop_back();
  } else {
    // Two rings in the middle where there is no middle one.
    std::vector<std::size_t> from_end;
    Keep(0, (count - 1) / 2, n, along, fineness, rows);
    Keep(count - 1, count / 2, n, along, fineness, from_end);
    rows.insert(rows.end(), from_end.rbegin(), from_end.rend());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  }
  const auto around = [&](std::size_t row, std::size_t column) {
    return rows[row] * n + column % n;
  };
  Keep(0, n, rows.size(), around, fineness, columns);
  columns.pop_back();
  RingGrid thinned(columns.size());
  for (const std::size_t row : rows) {
    for (const std::size_t column : columns) {
      thinned.points_.push_back(points_[row * n + column]);
      thinned.normals_.push_back(normals_[row * n + column]);
    }
  }
  return thinned;
}

TriangleMesh RingGrid::Mesh(bool closed) const {
  TriangleMesh mesh;
  mesh.positions = points_;
  mesh.normals = normals_;
  const int count = int(rings()), n = int(points_a_ring_);
  for (int k = 0; k < (closed ? count : count - 1); ++k) {
    for (int i = 0; i < n; ++i) {
      const int first = k * n, second = (k + 1) % count * n, j = (i + 1) % n;
      const int a = first + i, b = first + j, c = second + j, d = second + i;
      const auto at = [&](int v) { return mesh.positions[std::size_t(v)]; };
      if ((at(a) - at(c)).squaredNorm() <= (at(b) - at(d)).squaredNorm()) {
        mesh.triangles.emplace_back(a, b, c);
        mesh.triangles.emplace_back(a, c, d);
      } else {
        mesh.triangles.emplace_back(a, b, d);
        mesh.triangles.emplace_back(b, c, d);
      }
    }
  }
  return mesh;
}

}  // namespace lorgnette
