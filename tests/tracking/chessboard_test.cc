// SPDX-License-Identifier: Apache-2.0
// Cameras recovered from rendered boards; lens distortion, and pictures freed from it.
#include "tracking/chessboard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/tracking/rendered_board.h"

namespace lorgnette {
namespace {

using test::BoardPainter;
using test::BoardPose;
using test::BoardPoses;
using test::WideCamera;
using ::testing::HasSubstr;

const Chessboard kBoard{9, 6, 25};

// Corners where the camera itself puts them.
BoardCorners Exact(const CalibratedCamera& c, const Eigen::Isometry3d& pose) {
  BoardCorners corners;
  for (int row = 0; row < kBoard.rows; ++row) {
    for (int column = 0; column < kBoard.columns; ++column) {
      const Eigen::Vector3d p =
          pose * Eigen::Vector3d(column * kBoard.square_mm, row * kBoard.square_mm, 0);
      const Eigen::Vector2d at = c.distortion.Distorted(p.head<2>() / p.z());
      corners.push_back(c.camera.Project({at.x(), at.y(), 1}));
    }
  }
  return corners;
}

// How far apart two cameras put the same direction, worst over the picture, px.
double Apart(const CalibratedCamera& a, const CalibratedCamera& b) {
  double worst = 0;
  for (int y = 0; y <= a.camera.height; y += 20) {
    for (int x = 0; x <= a.camera.width; x += 20) {
      const auto ideal = a.distortion.Ideal(a.camera.Direction(x, y).head<2>());
      if (!ideal) return 1e9;
      const Eigen::Vector2d at = b.distortion.Distorted(*ideal);
      worst =
          std::max(worst, (b.camera.Project({at.x(), at.y(), 1}) - Eigen::Vector2d(x, y)).norm());
    }
  }
  return worst;
}

TEST(Calibrate, RecoversTheCameraOfRenderedBoards) {
  const CalibratedCamera truth = WideCamera();
  const BoardPainter painter(truth, kBoard);
  std::vector<BoardCorners> views;
  double worst = 0;
  for (const Eigen::Isometry3d& pose : BoardPoses(kBoard)) {
    const auto corners = FindChessboard(painter.Paint(pose), kBoard);
    ASSERT_TRUE(corners);
    // The board may be read from its other end.
    const BoardCorners exact = Exact(truth, pose);
    const bool turned = (corners->front() - exact.front()).norm() > 5;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const Eigen::Vector2d& e = exact[turned ? exact.size() - 1 - i : i];
      worst = std::max(worst, ((*corners)[i] - e).norm());
    }
    views.push_back(*corners);
  }
  // A fifth of a pixel is what the corner finder promises on a clean picture.
  EXPECT_LT(worst, 0.2);
  const auto found = Calibrate(kBoard, 640, 480, views);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_LT(found->camera.rms_px, 0.1);
  // Its own standard error holds what it is off by.
  EXPECT_NEAR(found->camera.camera.fx, truth.camera.fx, 4 * found->camera.focal_sigma_px);
  EXPECT_LT(found->camera.focal_sigma_px / truth.camera.fx, 0.002);
  EXPECT_EQ(found->camera.views, 12);
  EXPECT_EQ(found->views_left_out, 0);
  EXPECT_THAT(found->notes, ::testing::IsEmpty());
  // The worst place is a corner of the picture, 400 px out: a tenth of what the lens does there.
  EXPECT_LT(Apart(truth, found->camera), 1);
  EXPECT_GT(Apart(truth, {truth.camera, {}, 0, 0, 0}), 10);
}

TEST(Calibrate, IsExactOnExactCorners) {
  CalibratedCamera truth = WideCamera();
  truth.distortion.k3 = 0.01;
  std::vector<BoardCorners> views;
  for (const Eigen::Isometry3d& pose : BoardPoses(kBoard)) views.push_back(Exact(truth, pose));
  const auto found = Calibrate(kBoard, 640, 480, views);
  ASSERT_TRUE(found) << found.error().message;
  // Corners go to OpenCV as floats: 3e-5 px at 600 px.
  EXPECT_LT(found->camera.rms_px, 1e-4);
  EXPECT_LT(Apart(truth, found->camera), 0.01);
}

TEST(Calibrate, LeavesABadViewOut) {
  const CalibratedCamera truth = WideCamera();
  std::vector<BoardCorners> views;
  for (const Eigen::Isometry3d& pose : BoardPoses(kBoard)) views.push_back(Exact(truth, pose));
  for (std::size_t i = 0; i < views[3].size(); i += 2) views[3][i].x() += 6;  // a bent board
  const auto found = Calibrate(kBoard, 640, 480, views);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->views_left_out, 1);
  EXPECT_LT(Apart(truth, found->camera), 0.05);
}

TEST(Calibrate, SaysWhatIsMissing) {
  const CalibratedCamera truth = WideCamera();
  std::vector<BoardCorners> flat;
  for (const double x : {-40.0, -20.0, 0.0, 20.0, 40.0}) {
    flat.push_back(Exact(truth, BoardPose(kBoard, 0, 0, x, x / 2, 500)));
    for (Eigen::Vector2d& p : flat.back()) p.x() += 0.2 * std::sin(p.y() * 7 + x);  // noise
  }
  const auto few = Calibrate(kBoard, 640, 480, {flat[0], flat[1]});
  ASSERT_FALSE(few);
  EXPECT_THAT(few.error().message, HasSubstr("got 2 different views"));
  const auto alike = Calibrate(kBoard, 640, 480, flat);
  ASSERT_FALSE(alike);
  EXPECT_THAT(alike.error().message, HasSubstr("tilted"));
}

TEST(FindChessboard, FindsNothingInAnEvenPictureOrAHiddenBoard) {
  EXPECT_FALSE(FindChessboard(ImageRgb8(320, 240), kBoard));
  const BoardPainter painter(WideCamera(), kBoard);
  EXPECT_FALSE(FindChessboard(painter.Paint(BoardPose(kBoard, 0, 0, 260, 0, 420)), kBoard));
}

TEST(SameView, TellsAMovedBoardFromAHeldOne) {
  const CalibratedCamera c = WideCamera();
  const BoardCorners a = Exact(c, BoardPose(kBoard, 0, 0, 0, 0, 420));
  EXPECT_TRUE(SameView(a, Exact(c, BoardPose(kBoard, 0, 0, 1, 0, 420)), 640));
  EXPECT_FALSE(SameView(a, Exact(c, BoardPose(kBoard, 0, 0, 15, 0, 420)), 640));
}

TEST(LensDistortion, IdealUndoesDistorted) {
  const LensDistortion d = WideCamera().distortion;
  double worst = 0;
  for (double y = -0.5; y <= 0.5; y += 0.05) {
    for (double x = -0.65; x <= 0.65; x += 0.05) {
      const auto back = d.Ideal(d.Distorted({x, y}));
      ASSERT_TRUE(back) << x << " " << y;
      worst = std::max(worst, (*back - Eigen::Vector2d(x, y)).norm());
    }
  }
  EXPECT_LT(worst, 1e-12);
  EXPECT_EQ(LensDistortion{}.Distorted({0.3, -0.2}), Eigen::Vector2d(0.3, -0.2));
}

TEST(LensDistortion, HasNoIdealPositionPastItsFold) {
  // r (1 - r^2 / 3) turns back at r = 1, where it reaches 2/3.
  const LensDistortion d{-1.0 / 3, 0, 0, 0, 0};
  EXPECT_TRUE(d.Ideal({0.6, 0}));
  EXPECT_FALSE(d.Ideal({0.7, 0}));
}

TEST(PictureRectifier, MakesThePinholesPictureAndBringsChangesBack) {
  const CalibratedCamera real = WideCamera();
  const CalibratedCamera pinhole{real.camera, {}, 0, 0, 0};
  const Eigen::Isometry3d pose = BoardPose(kBoard, 10, 5, 0, 0, 420);
  const ImageRgb8 frame = BoardPainter(real, kBoard).Paint(pose);
  const ImageRgb8 ideal = BoardPainter(pinhole, kBoard).Paint(pose);
  const PictureRectifier rectifier(real.camera, real.distortion);
  const ImageRgb8 rectified = rectifier.Rectified(frame);
  // Corners lie where the pinhole sees them, to what the finder can tell.
  const auto seen = FindChessboard(rectified, kBoard), wanted = FindChessboard(ideal, kBoard);
  ASSERT_TRUE(seen && wanted);
  for (std::size_t i = 0; i < seen->size(); ++i) {
    EXPECT_LT(((*seen)[i] - (*wanted)[i]).norm(), 0.1) << i;
  }
  // A white square drawn about the pinhole's pixel (150, 100).
  ImageRgb8 changed = rectified;
  for (int y = 90; y < 110; ++y)
    std::fill(changed.at(140, y), changed.at(160, y), std::uint8_t(255));
  const ImageRgb8 back = rectifier.WithChanges(frame, rectified, changed);
  const Eigen::Vector2d at = real.distortion.Distorted(real.camera.Direction(150, 100).head<2>());
  const Eigen::Vector2d px = real.camera.Project({at.x(), at.y(), 1});
  EXPECT_EQ(*back.at(int(px.x()), int(px.y())), 255);
  int touched = 0;
  for (std::size_t i = 0; i < frame.data.size(); i += 3) touched += frame.data[i] != back.data[i];
  // The square of 20 x 20 px with its margin, a little smaller for the barrel.
  EXPECT_GT(touched, 200);
  EXPECT_LT(touched, 22 * 22 + 1);
  EXPECT_EQ(rectifier.WithChanges(frame, rectified, rectified).data, frame.data);
}

TEST(CameraFile, ComesBackFromItsFileAndScales) {
  const std::string text = R"({"format": "lorgnette-camera", "width": 640, "height": 480,
    "K": [[560, 0, 327], [0, 558, 236], [0, 0, 1]], "distortion": [-0.12, 0.02, 0.001, 0]})";
  const auto camera = ParseCameraFile(text, "cam.json");
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_EQ(camera->camera.fy, 558);
  EXPECT_EQ(camera->distortion.k3, 0);
  const std::string path = ::testing::TempDir() + "camera_file.json";
  ASSERT_TRUE(WriteCameraFile(*camera, path));
  const auto back = ReadCameraFile(path);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->camera.cx, 327);
  EXPECT_EQ(back->distortion.k1, -0.12);
  const auto half = ScaledTo(*camera, 320, 240, "cam.json");
  ASSERT_TRUE(half);
  EXPECT_EQ(half->camera.fx, 280);
  EXPECT_EQ(half->camera.cy, 118);
  const auto wide = ScaledTo(*camera, 1280, 720, "cam.json");
  ASSERT_FALSE(wide);
  EXPECT_THAT(wide.error().message, HasSubstr("640x480 pixels, and the video has 1280x720"));
}

TEST(CameraFile, RefusesWhatIsNoCamera) {
  const auto complaint = [](const std::string& from, const std::string& to) {
    std::string text = R"({"format": "lorgnette-camera", "width": 640, "height": 480,
      "K": [560, 0, 327, 0, 558, 236, 0, 0, 1], "distortion": [0, 0, 0, 0, 0]})";
    text.replace(text.find(from), from.size(), to);
    const auto camera = ParseCameraFile(text, "cam.json");
    return camera ? std::string("accepted") : camera.error().message;
  };
  EXPECT_THAT(complaint("lorgnette-camera", "cv"), HasSubstr("cam.json:format: got 'cv'"));
  EXPECT_THAT(complaint("[560, 0,", "[-560, 0,"), HasSubstr("cam.json:K: got another matrix"));
  EXPECT_THAT(complaint("[560, 0,", "[560, 4,"), HasSubstr("K: got another matrix"));
  EXPECT_THAT(complaint("[560, 0,", "["), HasSubstr("K: got 7 numbers, want 9"));
  EXPECT_THAT(complaint("[0, 0, 0, 0, 0]", "[0, 0]"), HasSubstr("distortion: got 2 numbers"));
  EXPECT_THAT(complaint("\"width\"", "\"wide\""), HasSubstr("wid"));
}

}  // namespace
}  // namespace lorgnette
