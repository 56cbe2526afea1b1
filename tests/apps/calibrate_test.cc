// SPDX-License-Identifier: Apache-2.0
// lorgnette calibrate, and cameras in track and tryon.
#include <filesystem>

#include "render/image_io.h"
#include "tests/apps/program_test_util.h"
#include "tests/tracking/rendered_board.h"

namespace lorgnette {
namespace {

using ::testing::HasSubstr;

class CalibrateTest : public ProgramTest {
 protected:
  // Pictures of a board that the wide camera took, `count` of them.
  std::vector<std::string> BoardPictures(std::size_t count) const {
    const Chessboard board{7, 5, 30};
    const test::BoardPainter painter(test::WideCamera(), board);
    const auto poses = test::BoardPoses(board);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i) {
      names.push_back(Path("view" + std::to_string(i) + ".png"));
      EXPECT_TRUE(WritePicture(painter.Paint(poses[i]), names.back()));
    }
    return names;
  }
};

TEST_F(CalibrateTest, WritesACameraFromPictures) {
  std::vector<std::string> arguments{"calibrate", "--board", "7x5", "--square", "30"};
  arguments.insert(arguments.end(), {"-o", Path("cam.json"), "--views"});
  for (const std::string& name : BoardPictures(9)) arguments.push_back(name);
  const Ran ran = Run(arguments);
  ASSERT_EQ(ran.code, kExitOk) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("640x480 pixels, focal length 5"));
  const auto camera = ReadCameraFile(Path("cam.json"));
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_NEAR(camera->camera.fx, test::WideCamera().camera.fx, 4 * camera->focal_sigma_px);
  EXPECT_GT(camera->focal_sigma_px, 0);
  EXPECT_LT(camera->rms_px, 0.15);
  // The file fits no other picture.
  const Ran track = Run({"track", "--video", Path("view0.png"), "--camera", Path("cam.json"),
                         "--focal", "500", "-o", Path("t.json")});
  EXPECT_EQ(track.code, kExitUsage);
  ExpectOneSentence(track.err);
}

TEST_F(CalibrateTest, SaysWhatIsWrong) {
  const std::vector<std::string> two = BoardPictures(2);
  const auto complaint = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"calibrate", "-o", Path("no.json")});
    const Ran ran = Run(std::move(arguments));
    EXPECT_NE(ran.code, kExitOk);
    ExpectOneSentence(ran.err);
    return ran.err;
  };
  EXPECT_THAT(complaint({"--board", "7x5", "--views", two[0], two[1]}),
              HasSubstr("2 pictures looked at, the 7x5 board whole in 2; got 2 different views"));
  EXPECT_THAT(complaint({"--board", "seven", "--views", two[0]}),
              HasSubstr("--board: got 'seven'"));
  EXPECT_THAT(complaint({"--square", "0", "--views", two[0]}), HasSubstr("--square: got 0 mm"));
  EXPECT_THAT(complaint({"--views", Path("none.png")}), HasSubstr("none.png"));
  EXPECT_FALSE(std::filesystem::exists(Path("no.json")));
}

TEST_F(CalibrateTest, RefusesACameraOfAnotherShape) {
  const std::vector<std::string> one = BoardPictures(1);
  const std::string camera = Write("cam.json", R"({"format": "lorgnette-camera", "width": 1280,
      "height": 720, "K": [1000, 0, 640, 0, 1000, 360, 0, 0, 1]})");
  const Ran ran = Run({"track", "--video", one[0], "--camera", camera, "-o", Path("track.json")});
  EXPECT_EQ(ran.code, kExitUsage);
  EXPECT_THAT(ran.err, HasSubstr("camera of 1280x720 pixels, and the video has 640x480"));
}

}  // namespace
}  // namespace lorgnette
