// SPDX-License-Identifier: Apache-2.0
#include "geometry/ring_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "geometry/sweep.h"

namespace lorgnette {
namespace {

// A torus, of radius 20 around and 2 across.
RingGrid Torus(int rings, int points) {
  RingGrid grid(static_cast<std::size_t>(points));
  for (int k = 0; k < rings; ++k) {
    const double a = 2 * kPi * k / rings;
    const Eigen::Vector3d out(std::cos(a), std::sin(a), 0);
    std::vector<Eigen::Vector3d> positions, normals;
    for (int i = 0; i < points; ++i) {
      const double b = 2 * kPi * i / points;
      normals.emplace_back(std::cos(b) * out + std::sin(b) * Eigen::Vector3d::UnitZ());
      positions.emplace_back(20 * out + 2 * normals.back());
    }
    grid.AddRing(positions, normals);
  }
  return grid;
}

// From the smooth torus, over points of all facets.
double GreatestDeviation(const TriangleMesh& mesh) {
  double most = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (const double u : {0.0, 0.25, 0.5}) {
      for (const double v : {0.0, 0.25, 0.5}) {
        const auto at = [&](int k) { return mesh.positions[std::size_t(t[k])]; };
        const Eigen::Vector3d p = (1 - u - v) * at(0) + u * at(1) + v * at(2);
        const double across = std::hypot(std::hypot(p.x(), p.y()) - 20, p.z());
        most = std::max(most, std::abs(across - 2));
      }
    }
  }
  return most;
}

TEST(RingGrid, ThinnedMeshesStayWithinTheStatedDistance) {
  const RingGrid fine = Torus(600, 120);
  std::size_t before = std::numeric_limits<std::size_t>::max();
  for (const double deviation : {0.005, 0.02, 0.08}) {
    const TriangleMesh mesh =
        fine.Thinned({.deviation_mm = deviation, .normal_deg = 90, .longest_mm = 100}, true)
            .Mesh(true);
    EXPECT_LT(mesh.triangles.size(), before);
    before = mesh.triangles.size();
    EXPECT_LT(GreatestDeviation(mesh), 2 * deviation + 0.002) << deviation;
    EXPECT_NEAR(std::abs(SignedVolume(mesh)) / (2 * kPi * kPi * 20 * 4), 1, deviation);
  }
}

TEST(RingGrid, SidesAreNoLongerThanAllowed) {
  const TriangleMesh mesh =
      Torus(600, 120)
          .Thinned({.deviation_mm = 9, .normal_deg = 180, .longest_mm = 3}, true)
          .Mesh(true);
  double longest = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    double sides[3];
    for (int k = 0; k < 3; ++k) {
      sides[k] =
          (mesh.positions[std::size_t(t[k])] - mesh.positions[std::size_t(t[(k + 1) % 3])]).norm();
    }
    std::sort(sides, sides + 3);  // the longest is the quad's diagonal
    longest = std::max(longest, sides[1]);
  }
  EXPECT_LE(longest, 3.0);
  EXPECT_GT(longest, 2.5);
}

TEST(RingGrid, WhatIsSymmetricStaysSo) {
  // A bent bar of 63 rings, bent most in its middle.
  RingGrid bar(12);
  for (int k = -31; k <= 31; ++k) {
    const double x = 0.5 * k, z = 6 / (1 + 0.05 * x * x);
    std::vector<Eigen::Vector3d> positions, normals;
    for (int i = 0; i < 12; ++i) {
      const double b = 2 * kPi * i / 12;
      normals.emplace_back(0, std::cos(b), std::sin(b));
      positions.push_back(Eigen::Vector3d(x, 0, z) + normals.back());
    }
    bar.AddRing(positions, normals);
  }
  const RingGrid thinned = bar.Thinned({.deviation_mm = 0.05}, false);
  EXPECT_LT(thinned.rings(), 45u);
  const TriangleMesh mesh = thinned.Mesh(false);
  for (const Eigen::Vector3d& p : mesh.positions) {
    EXPECT_TRUE(std::any_of(mesh.positions.begin(), mesh.positions.end(), [&](const auto& q) {
      return (q - Eigen::Vector3d(-p.x(), p.y(), p.z())).norm() < 1e-12;
    }));
  }
}

}  // namespace
}  // namespace lorgnette
