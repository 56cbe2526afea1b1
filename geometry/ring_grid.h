// SPDX-License-Identifier: Apache-2.0
// A smooth surface as a grid of points, ring after ring, and the part of the grid that a mesh needs
// to stay within a stated distance of it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/mesh.h"

namespace lorgnette {

// How coarse a mesh may be.
struct MeshFineness {
  double deviation_mm = 0.015;  // of a facet from the grid, along the rings and once more across
  double normal_deg = 3;        // of the normal between vertices from the grid's
  double longest_mm = 4;  // sides of the facets, so that light baked at vertices keeps its form
};

class RingGrid {
 public:
  explicit RingGrid(std::size_t points_a_ring) : points_a_ring_(points_a_ring) {}
  // points_a_ring points and unit normals, around the ring.
  void AddRing(const std::vector<Eigen::Vector3d>& points,
               const std::vector<Eigen::Vector3d>& normals);

  // Leaves out rings, then points of all rings alike.
  //   closed  the last ring is joined to the first; else rings are chosen from both ends to the
  //           middle, so that what is symmetric stays so
  RingGrid Thinned(const MeshFineness& fineness, bool closed) const;
  // Two triangles a quad, the diagonal along its shorter one; the ends of an open grid stay open.
  TriangleMesh Mesh(bool closed) const;
  std::size_t rings() const { return points_.size() / points_a_ring_; }
  std::size_t points_a_ring() const { return points_a_ring_; }

 private:
  template <typename At>
  void Keep(std::size_t first, std::size_t last, std::size_t lines, const At& at,
            const MeshFineness& fineness, std::vector<std::size_t>& kept) const;

  std::size_t points_a_ring_;
  std::vector<Eigen::Vector3d> points_, normals_;
};

}  // namespace lorgnette
