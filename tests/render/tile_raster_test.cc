// SPDX-License-Identifier: Apache-2.0
#include "render/tile_raster.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "render/adaptive_samples.h"
#include "tests/render/render_test_scene.h"

namespace lorgnette {
namespace {

// A closed box as a part of a frame, about a point of the head.
FramePart Box(const Eigen::Vector3d& centre, const Eigen::Vector3d& half) {
  FramePart part;
  part.name = "box";
  for (int i = 0; i < 8; ++i) {
    part.mesh.positions.push_back(centre + half.cwiseProduct(Eigen::Vector3d(
                                               i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  }
  const int squares[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& s : squares) {
    part.mesh.triangles.emplace_back(s[0], s[1], s[2]);
    part.mesh.triangles.emplace_back(s[0], s[2], s[3]);
  }
  ComputeVertexNormals(part.mesh);
  return part;
}

HeadScene Build(const Eyewear& eyewear) {
  CompositorOptions options;
  options.shadow = ShadowMode::kNone;
  auto head = HeadScene::Build(eyewear, test::Wall(120, 0), test::Wall(400, -60, 3),
                               Environment::Constant({1, 1, 1}), options);
  EXPECT_TRUE(head) << head.error().message;
  return *std::move(head);
}

// Seen from many sides, near and far: what Embree's rays meet.
TEST(TileRaster, MeetsWhatRaysMeet) {
  Eyewear eyewear = test::WithRims({});
  eyewear.frame.parts.push_back(Box({0, 20, 20}, {9, 4, 6}));
  const HeadScene head = Build(eyewear);
  ASSERT_EQ(head.frame.solid.size(), 2u);
  EXPECT_TRUE(head.frame.solid[0]);
  EXPECT_TRUE(head.frame.solid[1]);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> turn(-0.9, 0.9), away(150, 700);
  long met[3] = {0, 0, 0}, other = 0, all = 0;
  for (int pose = 0; pose < 20; ++pose) {
    test::View view = test::ViewFrom(0, 0, away(random), 160, 96, 300);
    view.camera_from_head.rotate(Eigen::AngleAxisd(turn(random), Eigen::Vector3d::UnitY()));
    view.camera_from_head.rotate(Eigen::AngleAxisd(turn(random), Eigen::Vector3d::UnitX()));
    const ScreenScene screen = ProjectScene(head, view.camera, view.camera_from_head);
    ASSERT_TRUE(screen.complete);
    const Eigen::Isometry3d head_from_camera = view.camera_from_head.inverse();
    TileRaster raster;
    std::vector<CameraSample> samples;
    std::vector<SceneHit> hits;
    for (std::size_t tile = 0; tile < screen.mask.content.size(); ++tile) {
      PlaceSamples(screen.mask.Area(tile, 160, 96), 1 + pose % 3, nullptr, samples);
      raster.Trace(head.visible, screen, tile, samples, hits);
      ASSERT_EQ(hits.size(), samples.size());
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const Eigen::Vector3d along =
            view.camera.Direction(double(samples[i].x), double(samples[i].y));
        const SceneHit ray =
            head.scene.Intersect(RaySet::kAll, head_from_camera.translation().cast<float>(),
                                 (head_from_camera.linear() * along).cast<float>(), 0, kEndless);
        const SceneHit& hit = hits[i];
        ++all;
        if (hit.object != ray.object || std::abs(hit.distance - ray.distance) > 0.02f) {
          ++other;  // across a silhouette, by rounding
          continue;
        }
        if (!hit.hit()) continue;
        ++met[std::size_t(hit.object)];
        // The weights lead back to the sample's place.
        const VisibleMesh& mesh = head.visible;
        const Eigen::Vector3i& t = mesh.triangles[mesh.FirstOf(hit.object) + hit.triangle];
        const Eigen::Vector3f point = (1 - hit.u - hit.v) * mesh.vertices[std::size_t(t[0])] +
                                      hit.u * mesh.vertices[std::size_t(t[1])] +
                                      hit.v * mesh.vertices[std::size_t(t[2])];
        const Eigen::Vector3d at = view.camera_from_head * point.cast<double>();
        const Eigen::Vector2d pixel = view.camera.Project(at);
        EXPECT_NEAR(pixel.x(), double(samples[i].x), 1e-3);
        EXPECT_NEAR(pixel.y(), double(samples[i].y), 1e-3);
        EXPECT_NEAR(at.z(), double(hit.distance), 1e-3 * double(hit.distance));
      }
    }
  }
  for (const long count : met) EXPECT_GT(count, 2000);
  // Rounding moves edges by some 1e-4 px.
  EXPECT_LT(double(other), 2e-4 * double(all));
}

// A plane of triangles of every shape over the first tile, 500 mm away; corners on the grid of
// samples, or anywhere.
struct Plane {
  VisibleMesh mesh;
  ScreenScene screen;
  Plane(bool exact, std::mt19937& random) {
    constexpr int kCells = 24;
    std::uniform_real_distribution<float> shift(-0.45f, 0.45f);
    std::uniform_int_distribution<int> quarter(-1, 1);
    screen.mask.columns = screen.mask.rows = 1;
    screen.mask.content = {kTileFrame};
    for (int j = 0; j <= kCells; ++j) {
      for (int i = 0; i <= kCells; ++i) {
        screen.points.push_back({-2 + float(i) * 0.9f, -2 + float(j) * 0.9f, 0.002f});
        ScreenPoint& p = screen.points.back();
        p.x = exact ? 0.25f * std::round(4 * p.x) + 0.25f * float(quarter(random))
                    : p.x + shift(random);
        p.y = exact ? 0.25f * std::round(4 * p.y) + 0.25f * float(quarter(random))
                    : p.y + shift(random);
      }
    }
    for (int j = 0; j < kCells; ++j) {
      for (int i = 0; i < kCells; ++i) {
        const int a = j * (kCells + 1) + i, b = a + 1, c = a + kCells + 1, d = c + 1;
        if (quarter(random) > 0) {
          mesh.triangles.emplace_back(a, b, d);
          mesh.triangles.emplace_back(d, a, c);
        } else {
          mesh.triangles.emplace_back(c, a, b);
          mesh.triangles.emplace_back(b, d, c);
        }
      }
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      screen.triangles.push_back(std::uint32_t(t));
    }
    screen.first = {0, std::uint32_t(mesh.triangles.size())};
  }
};

// On every instruction set that this machine has: no sample slips through.
TEST(TileRaster, LeavesNoGapBetweenTriangles) {
  std::vector<CameraSample> samples;
  PlaceSamples({0, 0, kTileSide, kTileSide}, 2, nullptr, samples);
  int targets = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();  // choose anew at the next call
    ++targets;
    std::mt19937 random(5);
    for (int round = 0; round < 40; ++round) {
      const Plane plane(round % 2 == 0, random);
      TileRaster raster;
      std::vector<SceneHit> hits;
      raster.Trace(plane.mesh, plane.screen, 0, samples, hits);
      for (std::size_t i = 0; i < hits.size(); ++i) {
        ASSERT_TRUE(hits[i].hit()) << hwy::TargetName(target) << ", " << round << ": "
                                   << samples[i].x << ", " << samples[i].y;
        EXPECT_NEAR(hits[i].distance, 500, 1e-2);
        const Eigen::Vector3i& t = plane.mesh.triangles[hits[i].triangle];
        const float w[3] = {1 - hits[i].u - hits[i].v, hits[i].u, hits[i].v};
        float x = 0, y = 0;
        for (int k = 0; k < 3; ++k) {
          x += w[k] * plane.screen.points[std::size_t(t[k])].x;
          y += w[k] * plane.screen.points[std::size_t(t[k])].y;
        }
        EXPECT_NEAR(x, samples[i].x, 1e-3);
        EXPECT_NEAR(y, samples[i].y, 1e-3);
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
  EXPECT_GE(targets, 1);
}

TEST(ScreenScene, SaysWhereTheCameraIsTooClose) {
  Eyewear eyewear = test::WithRims({});
  eyewear.frame.parts.push_back(Box({0, 20, 20}, {9, 4, 6}));
  const HeadScene head = Build(eyewear);
  const test::View apart = test::ViewFrom(0, 0, 300, 160, 96, 300);
  const ScreenScene before = ProjectScene(head, apart.camera, apart.camera_from_head);
  EXPECT_TRUE(before.complete);
  EXPECT_TRUE(std::count(before.mask.content.begin(), before.mask.content.end(), 0) > 0);
  // Between the box's front and back: every tile may change, and rays take over.
  const test::View within = test::ViewFrom(0, 30, 20, 160, 96, 300);
  const ScreenScene close = ProjectScene(head, within.camera, within.camera_from_head);
  EXPECT_FALSE(close.complete);
  EXPECT_EQ(std::count_if(close.mask.content.begin(), close.mask.content.end(),
                          [](std::uint8_t c) { return (c & kTileFrame) == 0; }),
            0);
  // Behind the camera is no obstacle.
  test::View turned = test::ViewFrom(0, 0, 900, 160, 96, 300);
  turned.camera_from_head =
      Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitY()) * turned.camera_from_head;
  EXPECT_TRUE(ProjectScene(head, turned.camera, turned.camera_from_head).complete);
}

}  // namespace
}  // namespace lorgnette
