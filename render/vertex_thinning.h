// SPDX-License-Identifier: Apache-2.0
// Vertices of a fine mesh that stand for their neighbours in what varies slowly along the surface
// and with its normal. Internal to render/.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "base/mesh.h"

namespace lorgnette {

class VertexThinning {
 public:
  // mesh with normals. Neighbours are alike up to 1.5 mm apart with normals up to 6 degrees apart:
  // on a rounded rim those along it, on flat parts all. Every vertex is kept or has kept ones alike
  // to it, of which the two most opposite stand for it.
  explicit VertexThinning(const TriangleMesh& mesh);

  const std::vector<std::uint32_t>& kept() const { return kept_; }
  // From a value for each kept vertex to one for each vertex.
  std::vector<Eigen::Vector3f> Expanded(const std::vector<Eigen::Vector3f>& of_kept) const;

 private:
  // Of a vertex: places in kept_, and the share of the first; twice itself where it is kept.
  struct Source {
    std::uint32_t one, other;
    float share;
  };
  std::vector<std::uint32_t> kept_;
  std::vector<Source> sources_;
};

}  // namespace lorgnette
