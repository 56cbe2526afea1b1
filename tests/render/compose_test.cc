// SPDX-License-Identifier: Apache-2.0
#include "render/compose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/atomic_file.h"
#include "cmake/source_dir.h"
#include "render/image_io.h"

namespace lorgnette {
namespace {

const std::string kTruth = LORGNETTE_SOURCE_DIR "/../shared/data/groundtruth/";

class GroundTruth : public testing::TestWithParam<const char*> {};

// Where every ray through a lens ends, against an independent analytic trace.
TEST_P(GroundTruth, FindsTheSamePointsBehindTheLenses) {
  const std::string folder = kTruth + GetParam();
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is missing";
  auto scene = ReadComposeCase(folder + "/case.json");
  ASSERT_TRUE(scene) << scene.error().message;
  scene->options.shadow = ShadowMode::kNone;
  const auto compositor = Compositor::Create(scene->eyewear, scene->head, TriangleMesh{},
                                             scene->environment, scene->options);
  ASSERT_TRUE(compositor) << compositor.error().message;
  const ImageRgbaF hits = compositor->HitMap(scene->camera, scene->camera_from_head);
  const auto truth = ReadExrRgba(folder + "/hit.exr");
  ASSERT_TRUE(truth) << truth.error().message;
  constexpr int kLeft = 245, kTop = 270;  // of the crop that the truth covers
  std::vector<double> errors_px;
  int other_code = 0;
  for (int y = 0; y < truth->height; ++y) {
    for (int x = 0; x < truth->width; ++x) {
      const float* t = truth->at(x, y);
      const float* h = hits.at(x + kLeft, y + kTop);
      other_code += std::lround(t[3]) != std::lround(h[3]);
      if (std::lround(t[3]) != 1 && std::lround(t[3]) != 2) continue;
      if (std::lround(t[3]) != std::lround(h[3])) continue;
      const auto project = [&](const float* p) {
        return scene->camera.Project(scene->camera_from_head *
                                     Eigen::Vector3d(double(p[0]), double(p[1]), double(p[2])));
      };
      errors_px.push_back((project(t) - project(h)).norm());
    }
  }
  ASSERT_GT(errors_px.size(), 10000u);
  std::sort(errors_px.begin(), errors_px.end());
  double mean = 0;
  for (const double e : errors_px) mean += e / double(errors_px.size());
  // The issue's bounds.
  EXPECT_LT(mean, 0.02);
  EXPECT_LT(errors_px[errors_px.size() * 95 / 100], 0.05);
  // A pixel's centre on an outline may fall to either side.
  EXPECT_LT(other_code, truth->width * truth->height / 1000);
}

INSTANTIATE_TEST_SUITE_P(Cases, GroundTruth,
                         testing::Values("m6_y0p0", "p5_y20p0", "tableI_y20p0"));

TEST(ReadComposeCase, NamesFileAndKeyOfAMistake) {
  const std::string path = testing::TempDir() + "compose_case.json";
  ASSERT_TRUE(WriteFileAtomically(path, R"({"image": {"width": 10, "height": -1}})"));
  const auto scene = ReadComposeCase(path);
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().message.find("compose_case.json"), std::string::npos)
      << scene.error().message;
  EXPECT_FALSE(ReadComposeCase(testing::TempDir() + "no_such_case.json"));
}

}  // namespace
}  // namespace lorgnette
