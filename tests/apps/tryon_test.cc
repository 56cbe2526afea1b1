// SPDX-License-Identifier: Apache-2.0
// lorgnette tryon and track, on a photograph where one is there, and on inputs that are wrong.
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <limits>

#include "cmake/source_dir.h"
#include "render/image_io.h"
#include "render/video_io.h"
#include "tests/apps/program_test_util.h"

namespace lorgnette {
namespace {

using testing::HasSubstr;

class TryonTest : public ProgramTest {
 protected:
  // A picture without a face.
  std::string Blank() const {
    ImageRgb8 image(96, 64);
    for (std::size_t i = 0; i < image.data.size(); ++i) {
      image.data[i] = static_cast<std::uint8_t>(100 + i % 7);
    }
    EXPECT_TRUE(WritePicture(image, Path("blank.png")));
    return Path("blank.png");
  }
  // An environment whose one texel is `value`.
  std::string Light(float value) const {
    ImageRgbF map(8, 4);
    std::fill(map.data.begin(), map.data.end(), 0.5f);
    map.at(3, 1)[1] = value;
    EXPECT_TRUE(WriteExr(map, Path("light.exr"), ExrDepth::kFloat));
    return Path("light.exr");
  }
  Ran Tryon(const std::string& video, const std::string& output,
            const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"tryon",   "--video", video, "--rx",      kTable1,
                                          "--frame", "panto",   "-o",  Path(output)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Run(arguments);
  }
  // The run failed with one sentence and left no output, whole or partial.
  void ExpectRefused(const Ran& ran, int code, const std::string& sentence,
                     const std::vector<std::string>& inputs) const {
    EXPECT_EQ(ran.code, code);
    EXPECT_THAT(ran.err, HasSubstr(sentence));
    ExpectOneSentence(ran.err);
    EXPECT_EQ(FilesHere(), inputs);
  }
};

TEST_F(TryonTest, MissingVideoIsNamed) {
  ExpectRefused(Tryon(Path("none.mp4"), "out.mp4"), kExitFailure,
                Path("none.mp4") + ": cannot be read: No such file", {});
}

TEST_F(TryonTest, BrokenVideoIsNamed) {
  Write("text.mp4", "this is no video");
  ExpectRefused(Tryon(Path("text.mp4"), "out.mp4"), kExitFailure,
                Path("text.mp4") + ": cannot be read: broken data", {"text.mp4"});
}

TEST_F(TryonTest, PrescriptionOutOfRangeIsNamedWithItsKey) {
  Blank();
  Write("rx.json", R"({"OD": {"sphere": -90}, "OS": {"sphere": 0}, "PD": 64})");
  const Ran ran = Run({"tryon", "--video", Path("blank.png"), "--rx", Path("rx.json"), "--frame",
                       "panto", "-o", Path("out.png")});
  ExpectRefused(ran, kExitUsage, "rx.json:OD.sphere: got -90", {"blank.png", "rx.json"});
}

TEST_F(TryonTest, UnknownFrameIsNamed) {
  Blank();
  const Ran ran = Run({"tryon", "--video", Path("blank.png"), "--rx", kTable1, "--frame", "monocle",
                       "-o", Path("out.png")});
  ExpectRefused(ran, kExitUsage, "monocle", {"blank.png"});
}

TEST_F(TryonTest, EnvironmentWithNanIsNamedWithItsTexel) {
  Blank();
  Light(std::numeric_limits<float>::quiet_NaN());
  ExpectRefused(Tryon(Path("blank.png"), "out.png", {"--env", Path("light.exr")}), kExitFailure,
                "light.exr:texel (3, 1): got nan", {"blank.png", "light.exr"});
}

TEST_F(TryonTest, PictureWithoutAFaceIsNamed) {
  if (!HasModels()) GTEST_SKIP() << "needs the face networks of scripts/setup in cache/models";
  Blank();
  ExpectRefused(Tryon(Path("blank.png"), "out.png"), kExitFailure, Path("blank.png") + ": no face",
                {"blank.png"});
}

TEST_F(TryonTest, OptionsOutOfRangeAreNamed) {
  const std::string blank = Blank();
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--frames", "9:3"}, "--frames: got 9:3, want A:B"},
      {{"--frames", "all"}, "--frames: got all, want A:B"},
      {{"--samples", "0"}, "--samples: got 0, want 1..8"},
      {{"--nudge", "1,2"}, "--nudge: got 2 numbers"},
      {{"--nudge", "1,2,300"}, "--nudge: got 300, want -30..30"},
      {{"--index", "1"}, "--index: got 1, want 1.3..2.2"},
      {{"--shadow", "soft"}, "--shadow"}};
  for (const auto& [more, sentence] : cases) {
    ExpectRefused(Tryon(blank, "out.png", more), kExitUsage, sentence, {"blank.png"});
  }
  ExpectRefused(Tryon(blank, "out.gif"), kExitUsage, "out.gif: unknown output format",
                {"blank.png"});
}

// Baking the shadow takes most of the time of one picture.
const std::vector<std::string> kQuick = {"--samples", "1", "--no-shadow"};

// A portrait through the whole program.
class PortraitTest : public TryonTest {
 protected:
  void SetUp() override {
    portrait_ = SharedData("photo/astronaut.png");
    if (!HasModels()) GTEST_SKIP() << "needs the face networks of scripts/setup in cache/models";
    if (!std::filesystem::exists(portrait_)) GTEST_SKIP() << "needs the portrait " << portrait_;
  }
  std::string portrait_;
};

TEST_F(PortraitTest, GetsGlassesAndAReport) {
  const Ran ran =
      Tryon(portrait_, "on.png",
            {"--report", Path("report.json"), "--samples", "1", "--stills", "1", "--no-shadow"});
  ASSERT_EQ(ran.code, kExitOk) << ran.err;
  EXPECT_EQ(FilesHere(), (std::vector<std::string>{"on.png", "on_still_0001.png", "report.json"}));
  const auto before = ReadPicture(portrait_), after = ReadPicture(Path("on.png"));
  ASSERT_TRUE(before && after);
  ASSERT_EQ(after->width, before->width);
  ASSERT_EQ(after->height, before->height);
  long changed = 0;
  for (int y = 0; y < after->height; ++y) {
    for (int x = 0; x < after->width; ++x) {
      changed += !std::equal(after->at(x, y), after->at(x, y) + 3, before->at(x, y));
    }
  }
  // The glasses and their shadow: more than the rims, less than the upper half of the picture.
  EXPECT_GT(changed, 500);
  EXPECT_LT(changed, long(after->width) * after->height / 2);
  // Far from the face nothing changes.
  EXPECT_TRUE(std::equal(after->at(0, 0), after->at(0, 20), before->at(0, 0)));

  const auto text = ReadFile(Path("report.json"));
  ASSERT_TRUE(text);
  const auto report = nlohmann::json::parse(*text);
  EXPECT_EQ(report["program"], std::string("lorgnette ") + ProgramVersion());
  EXPECT_EQ(report["video"]["frames"], 1);
  EXPECT_EQ(report["video"]["frames_without_face"], 0);
  EXPECT_EQ(report["video"]["width"], before->width);
  EXPECT_EQ(report["video"]["pd_mm"], 64);
  EXPECT_GT(report["rendering"]["lens_pixels"], 100);
  EXPECT_GT(report["seconds"]["render"], 0);
  ASSERT_EQ(report["lenses"].size(), 2u);
  EXPECT_EQ(report["lenses"][0]["order"]["sphere_D"], -4.25);
  EXPECT_EQ(report["lenses"][0]["order"]["axis_deg"], 160);
  EXPECT_EQ(report["lenses"][1]["order"]["sphere_D"], -4.5);
  for (const auto& lens : report["lenses"]) {
    for (const auto& row : lens["certificate"]) EXPECT_TRUE(row["passed"]) << row;
    EXPECT_GE(lens["center_thickness_mm"], 1.5);
  }
  for (const auto& distance : report["wearing_position"]["vertex_distance_mm"]) {
    EXPECT_GT(distance, 5);
    EXPECT_LT(distance, 25);
  }
}

TEST_F(PortraitTest, TrackFileServesInPlaceOfTracking) {
  const Ran tracked = Run({"track", "--video", portrait_, "--rx", kTable1, "-o", Path("t.json")});
  ASSERT_EQ(tracked.code, kExitOk) << tracked.err;
  ASSERT_EQ(Tryon(portrait_, "a.png", kQuick).code, kExitOk);
  std::vector<std::string> with_track = kQuick;
  with_track.insert(with_track.end(), {"--track", Path("t.json")});
  const Ran with_file = Tryon(portrait_, "b.png", with_track);
  ASSERT_EQ(with_file.code, kExitOk) << with_file.err;
  const auto a = ReadPicture(Path("a.png")), b = ReadPicture(Path("b.png"));
  ASSERT_TRUE(a && b);
  double difference = 0;
  for (std::size_t i = 0; i < a->data.size(); ++i) {
    difference += std::abs(a->data[i] - b->data[i]);
  }
  // The file rounds its numbers: single samples at the rims may fall on the other side.
  EXPECT_LT(difference / double(a->data.size()), 0.05);
  // Of another PD: refused, since the scale would be wrong.
  Write("rx.json", R"({"OD": {"sphere": 0}, "OS": {"sphere": 0}, "PD": 58})");
  const Ran other = Run({"tryon", "--video", portrait_, "--rx", Path("rx.json"), "--frame", "panto",
                         "--track", Path("t.json"), "-o", Path("c.png")});
  EXPECT_EQ(other.code, kExitFailure);
  EXPECT_THAT(other.err, HasSubstr("t.json: was made for a PD of 64 mm"));
  EXPECT_FALSE(std::filesystem::exists(Path("c.png")));
}

TEST_F(PortraitTest, FullDiskIsASentenceAndLeavesNothing) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{200, before.rlim_max};
  void (*handler)(int) = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const Ran image = Tryon(portrait_, "on.png", kQuick);
  const Ran video = Tryon(portrait_, "on.mp4", kQuick);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ExpectRefused(image, kExitFailure, "on.png: cannot be written: File too large", {});
  ExpectRefused(video, kExitFailure, "on.mp4: cannot be written: File too large", {});
}

}  // namespace
}  // namespace lorgnette
