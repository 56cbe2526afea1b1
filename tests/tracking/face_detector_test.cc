// SPDX-License-Identifier: Apache-2.0
#include "tracking/face_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lorgnette {
namespace {

TEST(DetectorAnchors, CoverBothGrids) {
  const auto anchors = DetectorAnchors();
  ASSERT_EQ(anchors.size(), std::size_t(kAnchors));
  EXPECT_EQ(anchors[0], Eigen::Vector2d(0.5 / 16, 0.5 / 16));
  EXPECT_EQ(anchors[1], anchors[0]);
  EXPECT_EQ(anchors[511], Eigen::Vector2d(15.5 / 16, 15.5 / 16));
  EXPECT_EQ(anchors[512], Eigen::Vector2d(0.5 / 8, 0.5 / 8));
  EXPECT_EQ(anchors[895], Eigen::Vector2d(7.5 / 8, 7.5 / 8));
}

struct NetworkOutput {
  std::vector<float> boxes = std::vector<float>(std::size_t(kAnchors) * 16, 0.0f);
  std::vector<float> scores = std::vector<float>(kAnchors, -20.0f);

  void Face(std::size_t anchor, float logit, float dx, float size) {
    float* v = boxes.data() + anchor * 16;
    v[0] = dx;
    v[2] = v[3] = size;
    for (int k = 4; k < 16; ++k) v[k] = dx;
    scores[anchor] = logit;
  }
};

TEST(DecodeDetections, FindsNothingInSilence) {
  const NetworkOutput out;
  EXPECT_TRUE(DecodeDetections(out.boxes.data(), out.scores.data(), 0.5).empty());
}

TEST(DecodeDetections, MergesOverlappingBoxesByScore) {
  NetworkOutput out;
  out.Face(0, 0.0f, 0, 40);   // score 1/2, centred on (4, 4)
  out.Face(1, 50.0f, 3, 40);  // score 1, 3 px to the right
  out.Face(511, 2.0f, 0, 10);
  const auto found = DecodeDetections(out.boxes.data(), out.scores.data(), 0.5);
  ASSERT_EQ(found.size(), 2u);
  // (1 * 3 + 0.5 * 0) / 1.5 = 2 px right of the anchor.
  EXPECT_NEAR((found[0].low.x() + found[0].high.x()) / 2, 6, 1e-9);
  EXPECT_NEAR(found[0].keys[5].x(), 6, 1e-9);
  EXPECT_NEAR(found[0].score, 1, 1e-9);
  EXPECT_NEAR(found[1].high.x() - found[1].low.x(), 10, 1e-9);
}

TEST(FaceDetector, NamesAMissingNetwork) {
  const auto detector = FaceDetector::Load("/nonexistent/face.onnx");
  ASSERT_FALSE(detector);
  EXPECT_THAT(detector.error().message, ::testing::HasSubstr("/nonexistent/face.onnx"));
}

}  // namespace
}  // namespace lorgnette
