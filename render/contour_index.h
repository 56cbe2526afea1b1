// SPDX-License-Identifier: Apache-2.0
// A closed polygon in the plane with fast answers: inside or not, how far the boundary is at
// least, and where a line leaves it. The outline of a cut lens.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace lorgnette {

class ContourIndex {
 public:
  // polygon: at least 3 distinct points, no repeated end point, either orientation (kept
  // counter-clockwise inside).
  explicit ContourIndex(std::vector<Eigen::Vector2d> polygon);

  const std::vector<Eigen::Vector2d>& polygon() const { return polygon_; }
  const Eigen::Vector2d& low() const { return low_; }
  const Eigen::Vector2d& high() const { return high_; }

  // By crossings with the polygon itself; false for a NaN.
  bool Contains(double x, double y) const;
  // Contains and Clearance at once.
  struct Place {
    bool inside;
    double clearance;
  };
  Place Locate(double x, double y) const;
  // Lower bounds of the distance to the boundary, at most one grid cell too small: from inside
  // (negative or 0 when that is not certain), and from outside.
  double Clearance(double x, double y) const;
  double OutsideBy(double x, double y) const;

  // Where the line p + t d first crosses the boundary with t in (t_min, t_max).
  struct Crossing {
    double t = 0;
    Eigen::Vector2d normal;  // unit, outward, interpolated between the vertices' normals
  };
  std::optional<Crossing> FirstCrossing(const Eigen::Vector2d& p, const Eigen::Vector2d& d,
                                        double t_min, double t_max) const;

 private:
  std::vector<Eigen::Vector2d> polygon_;
  std::vector<Eigen::Vector2d> vertex_normals_;
  Eigen::Vector2d low_{0, 0}, high_{0, 0};
  void IndexEdges();
  void MeasureDistances();
  std::size_t CellOf(double x, double y) const;  // the nearest to points beside the grid
  bool InGrid(double x, double y) const;
  bool CrossingsAreOdd(double x, double y) const;
  // Inside or not, in a cell that the boundary may cross: the centre is known, and the way from
  // there crosses edges of this cell only.
  bool InsideInCell(std::size_t cell, double x, double y) const;

  // Cells over the bounding box and a border around it.
  Eigen::Vector2d grid_low_{0, 0};
  int columns_ = 0, rows_ = 0;
  double cell_ = 1, inverse_cell_ = 1, half_diagonal_ = 0;
  std::vector<float> distance_;  // signed, of the cells' centres
  // Edges that touch cell i: cell_edges_[cell_first_[i] .. cell_first_[i + 1]).
  std::vector<std::uint32_t> cell_first_, cell_edges_;
};

}  // namespace lorgnette
