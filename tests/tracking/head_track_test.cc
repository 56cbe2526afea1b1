// SPDX-License-Identifier: Apache-2.0
#include "tracking/head_track.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <ostream>
#include <string>

#include "base/atomic_file.h"
#include "cmake/source_dir.h"
#include "tests/tracking/synthetic_face.h"
#include "tracking/camera_file.h"

namespace lorgnette {
namespace {

using ::testing::HasSubstr;

// Tests run side by side, each in a process of its own.
std::string TemporaryPath(const std::string& name) {
  return ::testing::TempDir() + std::to_string(getpid()) + "-" + name;
}

HeadTrack SmallTrack() {
  HeadTrack track;
  track.camera = test::TestCamera();
  track.pd_mm = 61.5;
  track.distortion = {-0.1, 0.02, 0.001, -0.002, 0.003};
  track.iris_pd_mm = 62.25;
  track.iris_pd_sigma_mm = 2.125;
  track.pupil_right = {-30.75, 0.25, 0};
  track.pupil_left = {30.75, -0.25, 0};
  track.face.positions = {{0, 0, 10}, {1.5, 0, 0}, {0, 2.25, -3}};
  track.face.uvs = {{0, 0}, {0.5f, 0.25f}, {1, 1}};
  track.face.triangles = {{0, 1, 2}};
  TrackedFrame found;
  found.time_s = 0;
  found.found = true;
  found.camera_from_head = test::TestPose(17, -4);
  found.residual_px = 1.5f;
  found.iris_left = Eigen::Vector2f(100.5f, 200.25f);
  for (const Eigen::Vector3d& p : track.face.positions) found.vertices.push_back(p.cast<float>());
  TrackedFrame lost;
  lost.time_s = 0.04;
  track.frames = {found, lost};
  return track;
}

// A track file as another program might write it, with one part replaced.
std::string Foreign(const std::string& from = "", const std::string& to = "") {
  std::string text = R"({
    "format": "lorgnette-head-track",
    "camera": {"width": 640, "height": 480, "fx": 700},
    "pd_mm": 63,
    "face": {"positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]},
    "frames": [{"time_s": 0.5, "camera_from_head": [1, 0, 0, 5,  0, -1, 0, 6,  0, 0, -1, 500,  0, 0, 0, 1]}]
  })";
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return text;
}

Result<HeadTrack> ReadText(const std::string& text) {
  const std::string path = TemporaryPath("track.json");
  EXPECT_TRUE(WriteFileAtomically(path, text));
  return ReadHeadTrack(path);
}

TEST(HeadTrack, ComesBackFromItsFile) {
  const HeadTrack track = SmallTrack();
  const std::string path = TemporaryPath("round_trip.json");
  ASSERT_TRUE(WriteHeadTrack(track, path));
  const auto back = ReadHeadTrack(path);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->camera.width, track.camera.width);
  EXPECT_EQ(back->camera.fy, track.camera.fy);
  EXPECT_EQ(back->distortion.k1, track.distortion.k1);
  EXPECT_EQ(back->distortion.k3, track.distortion.k3);
  EXPECT_EQ(back->pd_mm, track.pd_mm);
  EXPECT_EQ(back->iris_pd_mm, track.iris_pd_mm);
  EXPECT_EQ(back->iris_pd_sigma_mm, track.iris_pd_sigma_mm);
  EXPECT_EQ(back->pupil_right, track.pupil_right);
  EXPECT_EQ(back->pupil_left, track.pupil_left);
  EXPECT_EQ(back->face.positions, track.face.positions);
  EXPECT_EQ(back->face.uvs, track.face.uvs);
  EXPECT_EQ(back->face.triangles, track.face.triangles);
  EXPECT_EQ(back->face.normals.size(), track.face.positions.size());
  ASSERT_EQ(back->frames.size(), 2u);
  EXPECT_EQ(back->frames_without_face(), 1);
  EXPECT_EQ(back->frames[0].camera_from_head.matrix(), track.frames[0].camera_from_head.matrix());
  EXPECT_EQ(back->frames[0].vertices, track.frames[0].vertices);
  EXPECT_EQ(back->frames[0].residual_px, 1.5f);
  EXPECT_FALSE(back->frames[0].iris_right);
  ASSERT_TRUE(back->frames[0].iris_left);
  EXPECT_EQ(*back->frames[0].iris_left, *track.frames[0].iris_left);
  EXPECT_EQ(back->frames[1].time_s, 0.04);
}

TEST(HeadTrack, ReadsWhatAnotherProgramLeavesOut) {
  const auto track = ReadText(Foreign());
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_EQ(track->camera.fy, 700);
  EXPECT_EQ(track->camera.cx, 320);
  EXPECT_EQ(track->pupil_left, Eigen::Vector3d(31.5, 0, 0));
  EXPECT_TRUE(track->frames[0].found);
  EXPECT_TRUE(track->frames[0].vertices.empty());
  EXPECT_EQ(track->frames[0].camera_from_head.translation(), Eigen::Vector3d(5, 6, 500));
}

// The `nth` JSON example of the page.
std::string ExampleInDocs(int nth) {
  const auto page = ReadFile(LORGNETTE_SOURCE_DIR "/docs/tracking.md");
  if (!page) return page.error().message;
  const std::string fence = "```json\n";
  std::size_t from = 0;
  for (int i = 0; i <= nth; ++i) from = page->find(fence, from) + fence.size();
  return page->substr(from, page->find("```", from) - from);
}

TEST(HeadTrack, ReadsTheExampleOfItsDocumentation) {
  const auto track = ParseHeadTrack(ExampleInDocs(1), "docs/tracking.md");
  ASSERT_TRUE(track) << track.error().message;
  ASSERT_EQ(track->frames.size(), 3u);
  EXPECT_EQ(track->frames[1].vertices.size(), 3u);
  EXPECT_EQ(track->frames_without_face(), 1);
  const auto camera = ParseCameraFile(ExampleInDocs(0), "docs/tracking.md");
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_EQ(camera->views, 12);
}

struct Broken {
  const char* from;
  const char* to;
  const char* complaint;
};

void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.complaint; }

class BrokenTrack : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenTrack, IsRefusedWithFileKeyAndWish) {
  const auto track = ReadText(Foreign(GetParam().from, GetParam().to));
  ASSERT_FALSE(track);
  EXPECT_EQ(track.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(track.error().message, HasSubstr("track.json:"));
  EXPECT_THAT(track.error().message, HasSubstr(GetParam().complaint));
}

INSTANTIATE_TEST_SUITE_P(
    All, BrokenTrack,
    ::testing::Values(
        Broken{"\"pd_mm\": 63", "\"pd_mm\": 6.3", "pd_mm: got 6.3, want 40..90"},
        Broken{"\"pd_mm\"", "\"pd\"", "unknown key"},
        Broken{"lorgnette-head-track", "vtk", "format: got 'vtk'"},
        Broken{"\"fx\": 700", "\"fx\": -700", "camera.fx"},
        Broken{"\"fx\": 700", "\"fx\": 700, \"distortion\": [0.1]",
               "camera.distortion: got 1 numbers"},
        Broken{"[0, 1, 2]", "[0, 1, 3]", "got vertex 3, want a whole number 0..2"},
        Broken{"[0, 1, 2]", "[0, 1]", "got 2 numbers, want three a triangle"},
        Broken{"[0, 1, 0]]", "[0, 1]]", "got 8 numbers, want three a point"},
        Broken{"0, -1, 0, 6", "0, 1, 0, 6", "not a rotation"},
        Broken{"1, 0, 0, 5", "2, 0, 0, 5", "not a rotation"},
        Broken{"0, 0, 0, 1]", "0, 0, 1, 1]", "fourth row"},
        Broken{"1, 0, 0, 5, ", "1, 0, 0, ", "got 15 numbers, want 12"},
        Broken{"500", "5e9", "beyond 1e6"},
        Broken{"\"time_s\": 0.5,", "\"time_s\": 0.5, \"vertices\": [[0, 0, 0]],",
               "got 3 numbers, want 9"},
        Broken{"\"time_s\": 0.5,", "\"time_s\": 0.5, \"iris_left\": [1],", "want two, in pixels"},
        Broken{"}]\n", "}, {\"time_s\": 0.4, \"found\": false}]\n", "got 0.4, want at least 0.5"},
        Broken{"\"frames\": [", "\"frames\": [], \"note\": [",
               "frames: got none, want at least one frame"}));

TEST(HeadTrack, NamesAMissingFile) {
  const auto track = ReadHeadTrack("/nonexistent/track.json");
  ASSERT_FALSE(track);
  EXPECT_THAT(track.error().message, HasSubstr("/nonexistent/track.json"));
}

TEST(HeadTrack, LeavesNothingBehindWhereItCannotWrite) {
  EXPECT_FALSE(WriteHeadTrack(SmallTrack(), "/nonexistent/track.json"));
  EXPECT_FALSE(std::filesystem::exists("/nonexistent"));
}

}  // namespace
}  // namespace lorgnette
