// SPDX-License-Identifier: Apache-2.0
#include "base/mesh.h"

#include <Eigen/Geometry>

namespace lorgnette {

void ComputeVertexNormals(TriangleMesh& mesh) {
  mesh.normals.assign(mesh.positions.size(), Eigen::Vector3d::Zero());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.positions[std::size_t(t[0])];
    const Eigen::Vector3d& b = mesh.positions[std::size_t(t[1])];
    const Eigen::Vector3d& c = mesh.positions[std::size_t(t[2])];
    const Eigen::Vector3d twice_area = (b - a).cross(c - a);
    for (int k = 0; k < 3; ++k) mesh.normals[std::size_t(t[k])] += twice_area;
  }
  for (Eigen::Vector3d& n : mesh.normals) {
    const double length = n.norm();
    n = length > 0 ? Eigen::Vector3d(n / length) : Eigen::Vector3d::UnitZ();
  }
}

void Append(TriangleMesh& mesh, const TriangleMesh& other) {
  const bool was_empty = mesh.positions.empty();
  const bool keep_normals = !other.normals.empty() && (was_empty || !mesh.normals.empty());
  const bool keep_uvs = !other.uvs.empty() && (was_empty || !mesh.uvs.empty());
  const int offset = int(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  if (keep_normals) {
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
  } else {
    mesh.normals.clear();
  }
  if (keep_uvs) {
    mesh.uvs.insert(mesh.uvs.end(), other.uvs.begin(), other.uvs.end());
  } else {
    mesh.uvs.clear();
  }
  mesh.triangles.reserve(mesh.triangles.size() + other.triangles.size());
  for (const Eigen::Vector3i& t : other.triangles) {
    mesh.triangles.emplace_back(t + Eigen::Vector3i::Constant(offset));
  }
}

}  // namespace lorgnette
