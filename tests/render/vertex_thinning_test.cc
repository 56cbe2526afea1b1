// SPDX-License-Identifier: Apache-2.0
#include "render/vertex_thinning.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"

namespace lorgnette {
namespace {

constexpr int kRings = 60, kAround = 24;
constexpr double kRadius_mm = 2, kStep_mm = 0.5;

// A straight tube along x: neighbours along it are alike, those around it turn by 15 degrees.
TriangleMesh Tube() {
  TriangleMesh mesh;
  for (int r = 0; r < kRings; ++r) {
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * kPi * k / kAround;
      const Eigen::Vector3d out(0, std::cos(angle), std::sin(angle));
      mesh.positions.push_back(kRadius_mm * out + Eigen::Vector3d(kStep_mm * r, 0, 0));
      mesh.normals.push_back(out);
    }
  }
  for (int r = 0; r + 1 < kRings; ++r) {
    for (int k = 0; k < kAround; ++k) {
      const int a = r * kAround + k, b = r * kAround + (k + 1) % kAround;
      mesh.triangles.emplace_back(a, b, a + kAround);
      mesh.triangles.emplace_back(b, b + kAround, a + kAround);
    }
  }
  return mesh;
}

TEST(VertexThinning, KeepsEverySecondRingOfATube) {
  const TriangleMesh mesh = Tube();
  const VertexThinning thinning(mesh);
  EXPECT_EQ(thinning.kept().size(), mesh.positions.size() / 2);
}

TEST(VertexThinning, IsExactForWhatIsLinearAlongTheSurface) {
  const TriangleMesh mesh = Tube();
  const VertexThinning thinning(mesh);
  const auto value = [&](std::size_t i) {
    return Eigen::Vector3f(float(mesh.positions[i].x()), float(mesh.normals[i].y()),
                           float(mesh.normals[i].z()));
  };
  std::vector<Eigen::Vector3f> of_kept;
  for (const std::uint32_t i : thinning.kept()) of_kept.push_back(value(i));
  const auto all = thinning.Expanded(of_kept);
  ASSERT_EQ(all.size(), mesh.positions.size());
  // The last ring has a neighbour on one side only.
  for (std::size_t i = 0; i < all.size() - kAround; ++i) {
    EXPECT_LT((all[i] - value(i)).norm(), 1e-5f) << i;
  }
  for (std::size_t i = all.size() - kAround; i < all.size(); ++i) {
    EXPECT_LT((all[i] - value(i)).norm(), float(kStep_mm) + 1e-5f) << i;
  }
}

TEST(VertexThinning, KeepsVerticesWithoutAlikeOnes) {
  TriangleMesh mesh;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(9, 0, 0),
                                   Eigen::Vector3d(0, 9, 0), Eigen::Vector3d(5, 5, 5)}) {
    mesh.positions.push_back(p);
    mesh.normals.emplace_back(0, 0, 1);
  }
  mesh.triangles.emplace_back(0, 1, 2);  // its vertices are far apart; the fourth is in none
  EXPECT_EQ(VertexThinning(mesh).kept().size(), 4u);
}

}  // namespace
}  // namespace lorgnette
