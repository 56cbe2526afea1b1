// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "render/directions.h"
#include "render/lighting.h"
#include "render/paper_shadow.h"
#include "tests/render/render_test_scene.h"

namespace lorgnette {
namespace {

TEST(Directions, ShareTheSphereEvenly) {
  const auto directions = SphereDirections(1024);
  ASSERT_EQ(directions.size(), 1024u);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& d : directions) {
    EXPECT_NEAR(d.norm(), 1, 1e-6);
    mean += d.cast<double>() / 1024;
    second += d.cast<double>() * d.cast<double>().transpose() / 1024;
  }
  // A Fibonacci lattice integrates low polynomials to about 1/n.
  EXPECT_LT(mean.norm(), 2e-3);
  EXPECT_LT((second - Eigen::Matrix3d::Identity() / 3).norm(), 2e-3);
}

TEST(Directions, StratifyTheHemisphereByCosine) {
  const auto set = HemisphereStrata(160, 7);
  ASSERT_EQ(set.size(), 160u);
  // The mean of cos under the weight cos / pi is 2/3. Each of 160 strata has a spread below
  // 1/4 in cos^2: the error of a mean is some 0.01 without stratification, less with it.
  double mean = 0;
  for (const Eigen::Vector3f& d : set) {
    EXPECT_GE(d.z(), 0);
    EXPECT_NEAR(d.norm(), 1, 1e-5);
    mean += double(d.z()) / 160;
  }
  EXPECT_NEAR(mean, 2.0 / 3, 0.01);
  EXPECT_NE(HemisphereStrata(160, 8)[0], set[0]);
  EXPECT_EQ(HemisphereStrata(160, 7), set);
}

TEST(Directions, MakeARotationAboutAnyNormal) {
  for (const Eigen::Vector3f& n :
       {Eigen::Vector3f(0, 0, 1), Eigen::Vector3f(0, 0, -1), Eigen::Vector3f(0.6f, 0, -0.8f),
        Eigen::Vector3f(-0.48f, 0.6f, 0.64f)}) {
    const Eigen::Matrix3f b = BasisAbout(n);
    EXPECT_LT((b * b.transpose() - Eigen::Matrix3f::Identity()).norm(), 1e-6f);
    EXPECT_NEAR(b.determinant(), 1, 1e-6);
    EXPECT_EQ(b.col(2), n);
  }
}

TEST(Directions, HaveOrthonormalHarmonics) {
  const int n = 16384;
  const auto directions = SphereDirections(n);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(kHarmonics, kHarmonics);
  for (const Eigen::Vector3f& d : directions) {
    const Harmonics h = EvaluateHarmonics(d);
    for (int i = 0; i < kHarmonics; ++i) {
      for (int j = 0; j < kHarmonics; ++j) {
        gram(i, j) += 4 * kPi / n * double(h[std::size_t(i)]) * double(h[std::size_t(j)]);
      }
    }
  }
  // Products have degree 8; the lattice of n points errs there by some 10 / n.
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(kHarmonics, kHarmonics)).cwiseAbs().maxCoeff(), 2e-3);
}

// Under even light a disc of radius r at height h over a plane takes from the point below its
// centre the share sin^2 of its half angle: r^2 / (r^2 + h^2).
TriangleMesh Disc(double radius_mm, double height_mm) {
  TriangleMesh mesh;
  mesh.positions.emplace_back(0, 0, height_mm);
  constexpr int kSides = 256;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * kPi * i / kSides;
    mesh.positions.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle),
                                height_mm);
    mesh.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % kSides);
  }
  ComputeVertexNormals(mesh);
  return mesh;
}

struct Plate {
  TriangleMesh face = test::Wall(60, 0, 12);
  TriangleMesh disc = Disc(6, 8);
  EmbreeScene scene = *EmbreeScene::Build(face, TriangleMesh{}, disc);
};
constexpr double kExpected = 1 - 36.0 / (36 + 64);

TEST(PaperShadow, TakesTheShareOfADiscOverhead) {
  const Plate plate;
  const Environment light = Environment::Constant({1, 2, 3});
  const PaperShadow shadow(4096, true);
  const Eigen::Vector3f ratio =
      shadow.Ratio(plate.scene, light, Eigen::Matrix3f::Identity(), {{0, 0, 0}, {0, 0, 1}}, 3);
  // 4096 stratified rays against a circle: the boundary crosses some 4 sqrt(4096) strata, each of
  // which errs by at most 1/4096 in its share: below 0.016, and by chance some 0.002.
  EXPECT_NEAR(ratio.x(), kExpected, 0.006);
  EXPECT_NEAR(ratio.y(), ratio.x(), 1e-6);
}

TEST(PaperShadow, IsExactlyOneWhereTheFrameIsBelow) {
  const Plate plate;
  const PaperShadow shadow(160, true);
  EXPECT_EQ(shadow.Ratio(plate.scene, Environment::Constant({1, 1, 1}), Eigen::Matrix3f::Identity(),
                         {{0, 0, 20}, {0, 0, 1}}, 0),
            Eigen::Vector3f(1, 1, 1));
}

TEST(BakedShadow, AgreesWithThePaperMode) {
  const Plate plate;
  // Light that varies: a bright side and a dim one.
  ImageRgbF map(64, 32);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      for (int c = 0; c < 3; ++c) map.at(x, y)[c] = x < 32 ? 2.0f : 0.5f + 0.1f * float(c);
    }
  }
  const Environment environment(std::move(map));
  ShadowOptions options;
  const BakedShadow baked = BakedShadow::Bake(plate.scene, plate.face, plate.disc, options);
  EXPECT_GT(baked.touched_count(), 100u);
  EXPECT_LE(baked.touched_count(), baked.point_count());
  const auto light = LightAt(SphereDirections(options.directions),
                             BlurredEnvironment::ForCells(environment, options.directions),
                             Eigen::Matrix3f::Identity(), 1);
  const auto ratios = baked.Relight(light);
  const PaperShadow oracle(8192, true);
  double sum2 = 0, worst = 0;
  int count = 0;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int i = 0; i < 150; ++i) {
    const auto triangle = std::uint32_t(random() % plate.face.triangles.size());
    float u = unit(random), v = unit(random);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const Eigen::Vector3i& t = plate.face.triangles[triangle];
    const Eigen::Vector3f p = ((1 - u - v) * plate.face.positions[std::size_t(t[0])].cast<float>() +
                               u * plate.face.positions[std::size_t(t[1])].cast<float>() +
                               v * plate.face.positions[std::size_t(t[2])].cast<float>());
    const Eigen::Vector3f a = baked.Ratio(ratios, triangle, u, v);
    const Eigen::Vector3f b = oracle.Ratio(plate.scene, environment, Eigen::Matrix3f::Identity(),
                                           {p, {0, 0, 1}}, std::uint32_t(i));
    sum2 += double((a - b).squaredNorm()) / 3;
    worst = std::max(worst, double((a - b).cwiseAbs().maxCoeff()));
    ++count;
  }
  // The figure of the performance anchors for 1024 directions.
  EXPECT_LT(std::sqrt(sum2 / count), 0.02);
  EXPECT_LT(worst, 0.08);
}

TEST(BakedShadow, KnowsItsUntouchedTriangles) {
  TriangleMesh face = test::Wall(60, 0, 4);
  const TriangleMesh behind = Disc(6, -8);
  const EmbreeScene scene = *EmbreeScene::Build(face, TriangleMesh{}, behind);
  const BakedShadow baked = BakedShadow::Bake(scene, face, behind, {});
  EXPECT_EQ(baked.touched_count(), 0u);
  const auto ratios = baked.Relight(LightAt(
      SphereDirections(1024), BlurredEnvironment::ForCells(Environment::Constant({1, 1, 1}), 1024),
      Eigen::Matrix3f::Identity(), 1));
  for (std::uint32_t t = 0; t < face.triangles.size(); ++t) {
    EXPECT_FALSE(baked.touched(t));
    EXPECT_EQ(baked.Ratio(ratios, t, 0.2f, 0.3f), Eigen::Vector3f(1, 1, 1));
  }
}

// Points that take the mean of two others are close to what they would be if traced.
TEST(BakedShadow, LeavesOutPointsBetweenThoseThatSeeTheSame) {
  TriangleMesh face = test::Wall(60, 0, 6);
  const TriangleMesh disc = Disc(6, 8);
  const EmbreeScene scene = *EmbreeScene::Build(face, TriangleMesh{}, disc);
  ShadowOptions options, all;
  all.most_difference = -1;
  const BakedShadow some = BakedShadow::Bake(scene, face, disc, options);
  const BakedShadow every = BakedShadow::Bake(scene, face, disc, all);
  EXPECT_EQ(some.point_count(), every.point_count());
  EXPECT_LT(double(some.touched_count()), 0.8 * double(every.touched_count()));
  const HeadLight light = LightAt(
      SphereDirections(1024), BlurredEnvironment::ForCells(Environment::Constant({1, 1, 1}), 1024),
      Eigen::Matrix3f::Identity(), 1);
  const auto ratios = some.Relight(light), traced = every.Relight(light);
  double squares = 0;
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    const double off = double(ratios[i].x() - traced[i].x());
    EXPECT_LT(std::abs(off), 0.04);
    squares += off * off;
  }
  EXPECT_LT(std::sqrt(squares / double(ratios.size())), 0.006);
}

// A face that rises toward the frame takes the shadow that a bake of the risen face would give it,
// by and by where the budget is small.
TEST(BakedShadow, FollowsAFaceThatMoves) {
  TriangleMesh face = test::Wall(60, 0, 6);
  const TriangleMesh disc = Disc(6, 8);
  EmbreeScene scene = *EmbreeScene::Build(face, TriangleMesh{}, disc);
  const HeadLight light = LightAt(
      SphereDirections(1024), BlurredEnvironment::ForCells(Environment::Constant({1, 1, 1}), 1024),
      Eigen::Matrix3f::Identity(), 1);
  BakedShadow baked = BakedShadow::Bake(scene, face, disc, {});
  const std::vector<Eigen::Vector3f> before = baked.Relight(light);

  TriangleMesh risen = face;
  std::vector<Eigen::Vector3f> vertices;
  for (Eigen::Vector3d& p : risen.positions) {
    p.z() += 3;
    vertices.push_back(p.cast<float>());
  }
  scene.MoveFace(vertices);
  const std::vector<Eigen::Vector3f> fresh =
      BakedShadow::Bake(scene, risen, disc, {.most_difference = -1}).Relight(light);
  const auto off = [&](const std::vector<Eigen::Vector3f>& ratios) {
    double most = 0;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      most = std::max(most, double(std::abs(ratios[i].x() - fresh[i].x())));
    }
    return most;
  };
  EXPECT_GT(off(before), 0.1);
  EXPECT_EQ(baked.Follow(scene, vertices, 10), 10u);
  EXPECT_GT(off(baked.Relight(light)), 0.04);
  std::size_t followed = 0;
  while (const std::size_t now = baked.Follow(scene, vertices, 100)) followed += now;
  EXPECT_GT(followed, 100u);
  EXPECT_LT(off(baked.Relight(light)), 0.04);
}

// From z = -2 to 2.
TriangleMesh ClosedBox(double side_mm) {
  TriangleMesh box = test::Wall(side_mm, 2, 1);  // lid, floor and four sides of a closed box
  const int lid[4] = {0, 1, 3, 2};
  for (int i = 0; i < 4; ++i) {
    Eigen::Vector3d p = box.positions[std::size_t(i)];
    p.z() = -2;
    box.positions.push_back(p);
  }
  for (int i = 0; i < 4; ++i) {
    const int a = lid[i], b = lid[(i + 1) % 4];
    box.triangles.emplace_back(a, a + 4, b + 4);
    box.triangles.emplace_back(a, b + 4, b);
  }
  box.triangles.emplace_back(4, 7, 5);
  box.triangles.emplace_back(4, 6, 7);
  ComputeVertexNormals(box);
  return box;
}

// A coarse face mesh lets the frame cut into the skin: the points inside it are neither black nor
// bright, but like those beside it.
TEST(BakedShadow, GoesOnUnderPointsInsideTheFrame) {
  TriangleMesh face = test::Wall(20, 0, 4);
  const TriangleMesh box = ClosedBox(3);
  const EmbreeScene scene = *EmbreeScene::Build(face, TriangleMesh{}, box);
  const BakedShadow baked = BakedShadow::Bake(scene, face, box, {});
  const auto ratios = baked.Relight(LightAt(
      SphereDirections(1024), BlurredEnvironment::ForCells(Environment::Constant({1, 1, 1}), 1024),
      Eigen::Matrix3f::Identity(), 1));
  int inside = 0;
  for (std::uint32_t t = 0; t < face.triangles.size(); ++t) {
    for (const float u : {0.0f, 0.2f, 0.5f, 0.9f}) {
      for (const float v : {0.0f, 0.05f, 0.1f}) {
        const float ratio = baked.Ratio(ratios, t, u, v).x();
        // At the foot of a wall half of the sky is open.
        EXPECT_GT(ratio, 0.3f);
        EXPECT_LE(ratio, 1.0f);
        const Eigen::Vector3i& corners = face.triangles[t];
        const auto corner = [&](int k) { return face.positions[std::size_t(corners[k])]; };
        const Eigen::Vector3d at =
            double(1 - u - v) * corner(0) + double(u) * corner(1) + double(v) * corner(2);
        if (at.cwiseAbs().maxCoeff() > 0.75) continue;
        ++inside;
        EXPECT_LT(ratio, 0.8f);
      }
    }
  }
  EXPECT_GT(inside, 5);
}

TEST(BakedIrradiance, IsPiTimesTheLightInTheOpenAndHalfUnderAWall) {
  // A point on the floor before an endless wall: half of the cosine-weighted hemisphere is open.
  TriangleMesh wall;
  wall.positions = {{0, -1e4, -1}, {0, 1e4, -1}, {0, 1e4, 1e4}, {0, -1e4, 1e4}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  ComputeVertexNormals(wall);
  const EmbreeScene scene = *EmbreeScene::Build(test::Wall(1, -500), TriangleMesh{}, wall);
  TriangleMesh frame;
  frame.positions = {{1, 0, 0}, {-1, 0, 0}, {1, 0, 0}};
  frame.normals = {{0, 0, 1}, {0, 0, 1}, {1, 0, 0}};
  frame.triangles = {{0, 1, 2}};
  const auto baked = BakedIrradiance::Bake(scene, frame, 1024);
  const auto light = LightAt(SphereDirections(1024),
                             BlurredEnvironment::ForCells(Environment::Constant({1, 1, 1}), 1024),
                             Eigen::Matrix3f::Identity(), 1);
  const auto irradiance = baked.Relight(light, Eigen::Vector3f::Zero());
  // 1024 cells over the sphere: a straight boundary is off by about a cell's width, 0.1 rad / 20.
  EXPECT_NEAR(irradiance[0].x() / kPi, 0.5, 0.02);
  EXPECT_NEAR(irradiance[1].x() / kPi, 0.5, 0.02);
  EXPECT_NEAR(irradiance[2].x() / kPi, 1.0, 0.02);
}

TEST(BakedIrradiance, PartsInsideOthersAreLitLikeTheirNeighboursOutside) {
  // A bar that ends inside a box: the middle one of its three vertices is in there, and the last.
  const TriangleMesh box = ClosedBox(3);
  const EmbreeScene scene = *EmbreeScene::Build(test::Wall(1, -500), TriangleMesh{}, box);
  TriangleMesh bar;
  bar.positions = {{8, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}};
  bar.normals.assign(4, Eigen::Vector3d::UnitX());
  bar.triangles = {{0, 1, 2}, {1, 3, 2}};
  const auto baked = BakedIrradiance::Bake(scene, bar, 1024);
  const auto light = LightAt(SphereDirections(1024),
                             BlurredEnvironment::ForCells(Environment::Constant({1, 1, 1}), 1024),
                             Eigen::Matrix3f::Identity(), 1);
  const auto irradiance = baked.Relight(light, Eigen::Vector3f::Zero());
  EXPECT_NEAR(irradiance[0].x() / kPi, 1.0, 0.02);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_FLOAT_EQ(irradiance[i].x(), irradiance[0].x()) << i;
}

}  // namespace
}  // namespace lorgnette
