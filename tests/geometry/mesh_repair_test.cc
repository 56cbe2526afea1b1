// SPDX-License-Identifier: Apache-2.0
#include "geometry/mesh_repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "geometry/mesh_check.h"

namespace lorgnette {
namespace {

// A box of 10 x 6 x 4 mm whose sides are divided n times: closed, outward.
TriangleMesh Box(int n) {
  TriangleMesh mesh;
  const Eigen::Vector3d size(10, 6, 4);
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const int first = int(mesh.positions.size());
      for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
          Eigen::Vector3d p;
          p[axis] = side * size[axis];
          p[u] = size[u] * i / n;
          p[v] = size[v] * j / n;
          mesh.positions.push_back(p);
        }
      }
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          const int a = first + j * (n + 1) + i, b = a + n + 1;
          Eigen::Vector3i t1(a, a + 1, b + 1), t2(a, b + 1, b);
          if (side == 0) {
            std::swap(t1[1], t1[2]);
            std::swap(t2[1], t2[2]);
          }
          mesh.triangles.push_back(t1);
          mesh.triangles.push_back(t2);
        }
      }
    }
  }
  ComputeVertexNormals(mesh);
  return mesh;
}
constexpr double kBoxVolume = 240;

TEST(RepairMesh, LeavesASoundMeshAsItIs) {
  const TriangleMesh box = Box(4);
  TriangleMesh repaired = box;
  EXPECT_THAT(RepairMesh(repaired).Sentences(), testing::IsEmpty());
  EXPECT_EQ(repaired.triangles, box.triangles);
  EXPECT_EQ(repaired.normals, box.normals);
}

TEST(RepairMesh, TurnsFlippedFacesDropsBadOnesAndFillsAHole) {
  TriangleMesh mesh = Box(6);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 7) {
    std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
  }
  mesh.triangles.erase(mesh.triangles.begin() + 20, mesh.triangles.begin() + 22);  // one square
  mesh.triangles.push_back(mesh.triangles[3]);
  mesh.triangles.emplace_back(5, 5, 9);
  const MeshRepair done = RepairMesh(mesh);
  EXPECT_EQ(done.holes_filled, 1);
  EXPECT_EQ(done.triangles_dropped, 2);
  EXPECT_GT(done.triangles_turned, 40);
  EXPECT_EQ(done.open_edges, 0);
  const MeshReport report = CheckMesh(mesh, true);
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(report.self_intersections, 0);
  EXPECT_NEAR(report.volume_mm3, kBoxVolume, 1e-9);
  EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
}

TEST(RepairMesh, TurnsAPieceThatIsInsideOut) {
  TriangleMesh mesh = Box(2);
  for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
  for (Eigen::Vector3d& n : mesh.normals) n = -n;
  EXPECT_EQ(RepairMesh(mesh).pieces_turned, 1);
  EXPECT_NEAR(CheckMesh(mesh, false).volume_mm3, kBoxVolume, 1e-9);
  EXPECT_EQ(mesh.normals, Box(2).normals);
}

TEST(CheckMesh, TellsWhetherAnyPieceFacesInwards) {
  TriangleMesh mesh = Box(2), inverted = Box(2);
  for (Eigen::Vector3d& p : inverted.positions) p = 0.5 * p + Eigen::Vector3d(40, 0, 0);
  TriangleMesh both = mesh;
  Append(both, inverted);
  EXPECT_NEAR(CheckMesh(both, false).least_part_mm3, kBoxVolume / 8, 1e-9);
  for (Eigen::Vector3i& t : inverted.triangles) std::swap(t[1], t[2]);
  Append(mesh, inverted);
  const MeshReport report = CheckMesh(mesh, false);
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(report.components, 2);
  EXPECT_GT(report.volume_mm3, 0);
  EXPECT_NEAR(report.least_part_mm3, -kBoxVolume / 8, 1e-9);
}

TEST(RepairMesh, KeepsALargeOpeningAndCountsItsEdges) {
  TriangleMesh mesh = Box(4);
  std::erase_if(mesh.triangles, [&](const Eigen::Vector3i& t) {
    return mesh.positions[std::size_t(t[0])].z() == 4 &&
           mesh.positions[std::size_t(t[1])].z() == 4 && mesh.positions[std::size_t(t[2])].z() == 4;
  });
  const MeshRepair done = RepairMesh(mesh);
  EXPECT_EQ(done.holes_filled, 0);
  EXPECT_EQ(done.open_edges, 16);
}

TEST(RepairMesh, CountsTrianglesThatPassThroughEachOther) {
  TriangleMesh mesh = Box(1);
  // A corner pulled through the opposite side.
  for (Eigen::Vector3d& p : mesh.positions) {
    if (p == Eigen::Vector3d(10, 6, 4)) p = {-5, 3, 2};
  }
  EXPECT_GT(RepairMesh(mesh).crossing_pairs, 0);
}

TEST(RepairMesh, SurvivesMeshesWithoutASoundTriangle) {
  TriangleMesh flat;
  flat.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  flat.triangles = {{0, 1, 2}, {2, 2, 2}};
  EXPECT_EQ(RepairMesh(flat).triangles_dropped, 2);
  EXPECT_TRUE(flat.empty());
  TriangleMesh fan;  // five triangles on one edge
  fan.positions = {{0, 0, 0}, {0, 0, 1}};
  for (int k = 0; k < 5; ++k) {
    fan.positions.emplace_back(std::cos(k), std::sin(k), 0.5);
    fan.triangles.emplace_back(0, 1, k + 2);
  }
  RepairMesh(fan);
  EXPECT_EQ(fan.triangles.size(), 5u);
}

TEST(JoinNearPoints, MovesTwinsTogetherAndLeavesOthersApart) {
  TriangleMesh mesh;
  mesh.positions = {
      {0, 0, 0}, {0.5 * kJoin_mm, 0, 0}, {2.1 * kJoin_mm, 0, 0}, {-0.4 * kJoin_mm, 0, 0}};
  EXPECT_EQ(JoinNearPoints(mesh), 2);
  EXPECT_EQ(mesh.positions[1], mesh.positions[0]);
  EXPECT_EQ(mesh.positions[3], mesh.positions[0]);
  EXPECT_NE(mesh.positions[2], mesh.positions[0]);
}

}  // namespace
}  // namespace lorgnette
