// SPDX-License-Identifier: Apache-2.0
#include "render/middle_vertices.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/render/render_test_scene.h"

namespace lorgnette {
namespace {

TEST(MiddleVertices, LieBetweenTwoThatAreNone) {
  const TriangleMesh wall = test::Wall(20, 0, 10);  // 11 x 11 vertices
  const std::vector<MiddleVertex> middles = MiddleVertices(wall);
  EXPECT_GT(middles.size(), 40u);
  std::set<std::uint32_t> vertices;
  for (const MiddleVertex& m : middles) EXPECT_TRUE(vertices.insert(m.vertex).second);
  for (const MiddleVertex& m : middles) {
    EXPECT_FALSE(vertices.contains(m.one));
    EXPECT_FALSE(vertices.contains(m.other));
    const Eigen::Vector3d mean = 0.5 * (wall.positions[m.one] + wall.positions[m.other]);
    EXPECT_LT((mean - wall.positions[m.vertex]).norm(), 1e-12);
  }
}

TEST(MiddleVertices, AreNotOnSharpEdges) {
  // A roof: the ridge's normals differ from those of both sides.
  TriangleMesh roof;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) roof.positions.emplace_back(i, j == 1 ? 0 : 3 * (j - 1), 0);
  }
  const Eigen::Vector3d up(0, 0, 1);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) roof.normals.push_back(j == 1 ? up : Eigen::Vector3d(1, 0, 0));
  }
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const int a = 3 * j + i;
      roof.triangles.emplace_back(a, a + 1, a + 4);
      roof.triangles.emplace_back(a, a + 4, a + 3);
    }
  }
  const std::vector<MiddleVertex> middles = MiddleVertices(roof);
  EXPECT_FALSE(middles.empty());
  for (const MiddleVertex& m : middles) {
    EXPECT_EQ(roof.normals[m.vertex], roof.normals[m.one]);
    EXPECT_EQ(roof.normals[m.vertex], roof.normals[m.other]);
  }
}

}  // namespace
}  // namespace lorgnette
