// SPDX-License-Identifier: Apache-2.0
// The whole tracker on pictures of a known head at known poses.
#include "tracking/tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/tracking/synthetic_face.h"
#include "tests/tracking/test_inputs.h"

namespace lorgnette {
namespace {

using ::testing::HasSubstr;

ImageRgb8 ReadPicture(const std::string& path) {
  const cv::Mat bgr = cv::imread(path, cv::IMREAD_COLOR);
  ImageRgb8 image(bgr.cols, bgr.rows);
  cv::Mat rgb(bgr.rows, bgr.cols, CV_8UC3, image.data.data());
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  return image;
}

Tracker NewTracker(double focal_px) {
  auto tracker = Tracker::Create({test::kModels, 64, focal_px});
  EXPECT_TRUE(tracker) << tracker.error().message;
  return std::move(*tracker);
}

double YawDeg(const Eigen::Isometry3d& camera_from_head) {
  const Eigen::Vector3d out = camera_from_head.linear().col(2);
  return DegreesFromRadians(std::atan2(out.x(), -out.z()));
}

TEST(Tracker, ReadsTheTurnBetweenTwoPicturesOfAKnownHead) {
  NEED(test::kModels);
  NEED(test::kTruth);
  Tracker tracker = NewTracker(1680);
  ASSERT_TRUE(tracker.Add(ReadPicture(test::kTruth + "/pose_y0p0/input.png"), 0));
  ASSERT_TRUE(tracker.Add(ReadPicture(test::kTruth + "/pose_y20p0/input.png"), 1));
  const auto track = tracker.Finish();
  ASSERT_TRUE(track) << track.error().message;
  ASSERT_EQ(track->frames.size(), 2u);
  const Eigen::Isometry3d& first = track->frames[0].camera_from_head;
  const Eigen::Isometry3d& second = track->frames[1].camera_from_head;
  // Two pictures 20 degrees apart with nothing between them: 20.52 here. In a film, whose steps are
  // small, half a degree holds (known_head_test.cc).
  EXPECT_NEAR(YawDeg(second) - YawDeg(first), 20, 0.6);
  EXPECT_NEAR(YawDeg(first), 0, 1);
  // The head turns about the point midway between its pupils, 600 mm away.
  EXPECT_LT((second.translation() - first.translation()).norm(), 1.5);
  EXPECT_LT((first.translation() - Eigen::Vector3d(0, 0, 600)).norm(), 4);
  EXPECT_EQ(track->face.positions.size(), 468u);
  EXPECT_EQ(track->frames[0].vertices.size(), 468u);
  EXPECT_NEAR((track->pupil_left - track->pupil_right).norm(), 64, 1e-6);
}

TEST(Tracker, CountsFramesWithoutAFace) {
  NEED(test::kModels);
  NEED(test::kTruth);
  const ImageRgb8 face = ReadPicture(test::kTruth + "/pose_y0p0/input.png");
  const ImageRgb8 blank(face.width, face.height);
  Tracker tracker = NewTracker(0);
  for (int i = 0; i < 6; ++i) ASSERT_TRUE(tracker.Add(i == 2 || i == 3 ? blank : face, i / 25.0));
  const auto track = tracker.Finish();
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_EQ(track->frames_without_face(), 2);
  EXPECT_FALSE(track->frames[2].found);
  EXPECT_TRUE(track->frames[4].found);
  EXPECT_LT((track->frames[4].camera_from_head.translation() -
             track->frames[1].camera_from_head.translation())
                .norm(),
            1);
}

TEST(Tracker, SaysThatNoFrameShowsAFace) {
  NEED(test::kModels);
  Tracker tracker = NewTracker(0);
  const ImageRgb8 blank(320, 240);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(tracker.Add(blank, i / 25.0));
  const auto track = tracker.Finish();
  ASSERT_FALSE(track);
  EXPECT_THAT(track.error().message, HasSubstr("no face found in any of 3 frames"));
}

TEST(Tracker, RefusesFramesOfAnotherSize) {
  NEED(test::kModels);
  Tracker tracker = NewTracker(0);
  ASSERT_TRUE(tracker.Add(ImageRgb8(320, 240), 0));
  const Status other = tracker.Add(ImageRgb8(240, 320), 0.04);
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message, HasSubstr("got 240x320, want 320x240"));
  EXPECT_FALSE(tracker.Add(ImageRgb8(), 0.08));
}

TEST(Tracker, RefusesAScaleOutOfRange) {
  const auto tracker = Tracker::Create({test::kModels, 6.4, 0});
  ASSERT_FALSE(tracker);
  EXPECT_THAT(tracker.error().message, HasSubstr("pd: got 6.4 mm, want 40..90"));
  EXPECT_FALSE(Tracker::Create({test::kModels, 64, -1}));
}

TEST(Tracker, NamesMissingNetworks) {
  const auto tracker = Tracker::Create({"/nonexistent", 64, 0});
  ASSERT_FALSE(tracker);
  EXPECT_THAT(tracker.error().message, HasSubstr("/nonexistent/canonical_face.obj"));
}

}  // namespace
}  // namespace lorgnette
