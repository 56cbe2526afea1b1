// SPDX-License-Identifier: Apache-2.0
// Indexed triangle mesh, in mm. Counter-clockwise triangles seen from outside.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace lorgnette {

struct TriangleMesh {
  std::vector<Eigen::Vector3d> positions;  // mm
  std::vector<Eigen::Vector3d> normals;    // unit, one a vertex; empty: flat
  std::vector<Eigen::Vector2f> uvs;        // one a vertex; empty: none; v runs downwards
  std::vector<Eigen::Vector3i> triangles;

  bool empty() const { return triangles.empty(); }
};

// Area-weighted vertex normals; a vertex of no triangle of non-zero area gets +z.
void ComputeVertexNormals(TriangleMesh& mesh);

// Appends `other` with its indices moved; normals and uvs are kept only when both have them.
void Append(TriangleMesh& mesh, const TriangleMesh& other);

}  // namespace lorgnette
