// SPDX-License-Identifier: Apache-2.0
#include "base/mesh.h"

#include <gtest/gtest.h>

#include <limits>

namespace lorgnette {
namespace {

// Coordinates of order 1, a handful of operations a component.
constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();

TriangleMesh Tetrahedron() {
  TriangleMesh mesh;
  mesh.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  return mesh;
}

TEST(ComputeVertexNormals, PointOutwardsOnAClosedConvexMesh) {
  TriangleMesh mesh = Tetrahedron();
  ComputeVertexNormals(mesh);
  ASSERT_EQ(mesh.normals.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    // By symmetry the normal at a corner of a regular tetrahedron is its direction.
    EXPECT_TRUE(mesh.normals[i].isApprox(mesh.positions[i].normalized(), kRounding)) << i;
  }
}

TEST(ComputeVertexNormals, WeighsByArea) {
  TriangleMesh mesh;  // an upright triangle of area 1/2 and a level one of area 2 share vertex 0
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {2, 0, 0}, {0, 2, 0}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 4}};
  ComputeVertexNormals(mesh);
  const Eigen::Vector3d expected = Eigen::Vector3d(0, 0.5, 2).normalized();
  EXPECT_TRUE(mesh.normals[0].isApprox(expected, kRounding)) << mesh.normals[0].transpose();
}

TEST(ComputeVertexNormals, GivesLooseAndCollapsedVerticesPlusZ) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}};
  mesh.triangles = {{0, 1, 2}};
  ComputeVertexNormals(mesh);
  for (const auto& normal : mesh.normals) EXPECT_EQ(normal, Eigen::Vector3d::UnitZ());
}

TEST(Append, MovesIndicesAndKeepsBothMeshes) {
  TriangleMesh mesh = Tetrahedron();
  TriangleMesh other = Tetrahedron();
  for (auto& p : other.positions) p.x() += 10;
  Append(mesh, other);
  ASSERT_EQ(mesh.positions.size(), 8u);
  ASSERT_EQ(mesh.triangles.size(), 8u);
  EXPECT_EQ(mesh.triangles[0], Eigen::Vector3i(0, 1, 2));
  EXPECT_EQ(mesh.triangles[4], Eigen::Vector3i(4, 5, 6));
  EXPECT_EQ(mesh.positions[4], other.positions[0]);
}

TEST(Append, KeepsNormalsOnlyWhenBothHaveThem) {
  TriangleMesh with = Tetrahedron();
  ComputeVertexNormals(with);
  const TriangleMesh without = Tetrahedron();

  TriangleMesh both = with;
  Append(both, with);
  EXPECT_EQ(both.normals.size(), 8u);
  TriangleMesh mixed = with;
  Append(mixed, without);
  EXPECT_TRUE(mixed.normals.empty());
  TriangleMesh from_nothing;
  Append(from_nothing, with);
  EXPECT_EQ(from_nothing.normals.size(), 4u);
}

TEST(Append, KeepsTextureCoordinatesOnlyWhenBothHaveThem) {
  TriangleMesh with = Tetrahedron();
  with.uvs.assign(4, Eigen::Vector2f(0.25F, 0.5F));
  TriangleMesh both = with;
  Append(both, with);
  EXPECT_EQ(both.uvs.size(), 8u);
  Append(both, Tetrahedron());
  EXPECT_TRUE(both.uvs.empty());
}

TEST(Append, OfNothingChangesNothing) {
  TriangleMesh mesh = Tetrahedron();
  Append(mesh, TriangleMesh{});
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_FALSE(mesh.empty());
  EXPECT_TRUE(TriangleMesh{}.empty());
}

}  // namespace
}  // namespace lorgnette
