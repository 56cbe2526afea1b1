// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "apps/frame_range.h"
#include "apps/still_choice.h"
#include "apps/tryon_pipeline.h"
#include "base/units.h"

namespace lorgnette {
namespace {

TEST(FrameRange, ReadsBothEndsAndLeavesThemOpen) {
  const auto both = ParseFrameRange("3:7");
  ASSERT_TRUE(both);
  EXPECT_FALSE(both->Contains(2));
  EXPECT_TRUE(both->Contains(3));
  EXPECT_TRUE(both->Contains(7));
  EXPECT_FALSE(both->Contains(8));
  EXPECT_EQ(both->Count(100), 5);
  EXPECT_EQ(both->Count(5), 2);
  EXPECT_EQ(both->Count(0), 5);
  EXPECT_EQ(ParseFrameRange("4:")->Count(10), 6);
  EXPECT_EQ(ParseFrameRange(":4")->Count(10), 5);
  EXPECT_TRUE(ParseFrameRange("")->IsWhole());
  EXPECT_FALSE(ParseFrameRange("4:")->IsWhole());
}

TEST(FrameRange, RefusesWhatIsNone) {
  for (const char* text : {"3", "a:b", "7:3", "-1:4", "1:2:3", "1.5:2", " 1:2"}) {
    EXPECT_FALSE(ParseFrameRange(text)) << text;
  }
}

Eigen::Isometry3d Facing(double yaw_deg, double pitch_deg, double roll_deg) {
  // A head that faces the camera, turned about its own axes.
  const Eigen::Matrix3d facing = Eigen::Vector3d(1, -1, -1).asDiagonal();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() =
      facing * (Eigen::AngleAxisd(RadiansFromDegrees(yaw_deg), Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(-RadiansFromDegrees(pitch_deg), Eigen::Vector3d::UnitX()) *
                Eigen::AngleAxisd(-RadiansFromDegrees(roll_deg), Eigen::Vector3d::UnitZ()))
                   .toRotationMatrix();
  return pose;
}

TEST(HeadAngles, HaveTheSignsOfTheirNames) {
  constexpr double kBound = 1e-12;  // degrees; rounding of a few sines
  EXPECT_NEAR(AnglesOf(Facing(0, 0, 0)).yaw, 0, kBound);
  EXPECT_NEAR(AnglesOf(Facing(25, 0, 0)).yaw, 25, kBound);
  EXPECT_NEAR(AnglesOf(Facing(0, 12, 0)).pitch, 12, kBound);
  EXPECT_NEAR(AnglesOf(Facing(0, 0, 7)).roll, 7, kBound);
  const HeadAngles all = AnglesOf(Facing(-20, 10, 5));
  EXPECT_NEAR(all.yaw, -20, kBound);
  EXPECT_NEAR(all.pitch, 10, kBound);
  EXPECT_NEAR(all.roll, 5, kBound);
}

HeadTrack Turning(int frames) {
  HeadTrack track;
  for (int i = 0; i < frames; ++i) {
    TrackedFrame frame;
    frame.found = i != 3;
    frame.camera_from_head = Facing(i == 17 ? -40 : i, 0, 0);
    track.frames.push_back(frame);
  }
  return track;
}

TEST(ChooseStills, SpreadsThemAndTakesTheMostTurnedFrame) {
  const auto chosen = ChooseStills(Turning(31), 4);
  EXPECT_EQ(chosen.size(), 4u);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  EXPECT_EQ(std::count(chosen.begin(), chosen.end(), 17), 1);
  EXPECT_LT(chosen.front(), 8);
  EXPECT_GT(chosen.back(), 23);
}

TEST(ChooseStills, TakesNoMoreThanThereAreAndNoneWithoutAFace) {
  EXPECT_EQ(ChooseStills(Turning(3), 10).size(), 3u);
  EXPECT_TRUE(ChooseStills(Turning(10), 0).empty());
  EXPECT_TRUE(ChooseStills(HeadTrack{}, 5).empty());
  for (const long index : ChooseStills(Turning(8), 8)) EXPECT_NE(index, 3);
}

}  // namespace
}  // namespace lorgnette
