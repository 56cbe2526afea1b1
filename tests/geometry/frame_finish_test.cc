// SPDX-License-Identifier: Apache-2.0
#include "geometry/frame_finish.h"

#include <gtest/gtest.h>

namespace lorgnette {
namespace {

FrameModel TwoParts() {
  FrameModel frame;
  frame.parts.resize(2);
  frame.parts[0].kind = FramePartKind::kFront;
  frame.parts[1].kind = FramePartKind::kNosePad;
  return frame;
}

TEST(FrameFinish, ReadsColours) {
  const auto white = ParseFrameColor("#ffffff");
  ASSERT_TRUE(white);
  EXPECT_NEAR((*white - Eigen::Vector3f::Ones()).norm(), 0, 1e-6);
  EXPECT_NEAR(ParseFrameColor("#800000")->x(), 0.2158605, 1e-6);  // IEC 61966-2-1
  EXPECT_EQ(ParseFrameColor("#800000")->z(), 0);
  for (const char* wrong : {"", "800000", "#80000", "#8000000", "#80000g", "# 8000", "red"}) {
    const auto refused = ParseFrameColor(wrong);
    ASSERT_FALSE(refused) << wrong;
    EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  }
}

TEST(FrameFinish, LeavesPadsAsTheyAre) {
  FrameModel frame = TwoParts();
  const Eigen::Vector3f before = frame.parts[1].material.diffuse;
  Refinish(FrameFinish::kMetal, Eigen::Vector3f(0.9f, 0.7f, 0.3f), frame);
  ASSERT_NE(frame.parts[0].material.pbr, nullptr);
  EXPECT_EQ(frame.parts[0].material.pbr->metallic, 1);
  EXPECT_EQ(frame.parts[1].material.pbr, nullptr);
  EXPECT_EQ(frame.parts[1].material.diffuse, before);
}

TEST(FrameFinish, AColourAloneKeepsTheGloss) {
  FrameModel frame = TwoParts();
  const Eigen::Vector3f specular = frame.parts[0].material.specular;
  Refinish(std::nullopt, Eigen::Vector3f(0, 0.5f, 0), frame);
  EXPECT_EQ(frame.parts[0].material.diffuse, Eigen::Vector3f(0, 0.5f, 0));
  EXPECT_EQ(frame.parts[0].material.specular, specular);
  Refinish(FrameFinish::kClear, std::nullopt, frame);
  EXPECT_EQ(frame.parts[0].material.pbr->base_color, Eigen::Vector3f(0, 0.5f, 0));
  EXPECT_GT(frame.parts[0].material.pbr->transmission, 0.5f);
}

TEST(FrameFinish, KnowsItsNames) {
  for (const std::string& name : FrameFinishNames()) EXPECT_TRUE(FindFrameFinish(name)) << name;
  EXPECT_FALSE(FindFrameFinish("velvet"));
}

}  // namespace
}  // namespace lorgnette
