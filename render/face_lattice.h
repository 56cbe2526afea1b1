// SPDX-License-Identifier: Apache-2.0
// Points on a face mesh for what is baked: a lattice on each triangle, fine near the frame, so that
// a coarse mesh does not blur the contact; and values between them. Internal to render/.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "base/mesh.h"

namespace lorgnette {

struct LatticePoint {
  std::uint32_t triangle;
  float u, v;                        // weights of the triangle's second and third vertex
  Eigen::Vector3f position, normal;  // smooth normal, unit
};

class FaceLattice {
 public:
  FaceLattice() = default;
  // face with normals; points at most near_mm apart within 6 mm of the frame, else far_mm. Points
  // at the mesh's own vertices are shared by its triangles, and those on its edges by triangles of
  // as many points.
  FaceLattice(const TriangleMesh& face, const TriangleMesh& frame, double near_mm, double far_mm);

  const std::vector<LatticePoint>& points() const { return points_; }
  // Points in the middle between two others, where their mean may do, coarse ones first: a point's
  // two others are of no list, or of one before its own.
  struct Between {
    std::uint32_t point, one, other;
  };
  static constexpr int kLevels = 2;
  const std::array<std::vector<Between>, kLevels>& between() const { return between_; }
  // Triangles with a marked point are touched; the values of the others are not asked for.
  void Touch(const std::vector<bool>& marked);
  bool touched(std::uint32_t triangle) const { return lattices_[triangle].touched; }

  // Linear between the points' values. Those that hold kNoValue in x are passed over; 1 when all
  // do.
  static constexpr float kNoValue = -1;
  Eigen::Vector3f Interpolate(const std::vector<Eigen::Vector3f>& values, std::uint32_t triangle,
                              float u, float v) const;

 private:
  struct Lattice {
    std::uint32_t first = 0;  // into corners_
    std::uint16_t cells = 1;  // along each side
    bool touched = false;
  };
  std::vector<LatticePoint> points_;
  std::array<std::vector<Between>, kLevels> between_;
  std::vector<Lattice> lattices_;       // one a triangle
  std::vector<std::uint32_t> corners_;  // point indices, (cells + 1)(cells + 2) / 2 a triangle
};

}  // namespace lorgnette
