// SPDX-License-Identifier: Apache-2.0
#include "tracking/track_smoothing.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/tracking/synthetic_face.h"

namespace lorgnette {
namespace {

using test::AngleDeg;
using test::TestPose;

struct Clip {
  HeadTrack track;
  std::vector<bool> cut_before;
  std::vector<double> confidence;

  explicit Clip(int count) : cut_before(std::size_t(count)), confidence(std::size_t(count), 1) {
    track.camera = test::TestCamera();
    for (int i = 0; i < count; ++i) {
      TrackedFrame& frame = track.frames.emplace_back();
      frame.time_s = i / 25.0;
      frame.found = true;
      frame.camera_from_head = TestPose(0.2 * i);
    }
  }
};

TEST(SmoothTrack, RemovesWobble) {
  Clip clip(100);
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 1);
  for (TrackedFrame& frame : clip.track.frames)
    frame.camera_from_head.translation().z() += noise(random);
  SmoothTrack(clip.cut_before, clip.confidence, clip.track);
  double squares = 0;
  for (std::size_t i = 10; i < 90; ++i) {
    const double z = clip.track.frames[i].camera_from_head.translation().z();
    squares += (z - 600) * (z - 600) / 80;
  }
  // A third of the band up to 12.5 Hz passes, and a few samples stand out by chance.
  EXPECT_LT(std::sqrt(squares), 0.75);
}

TEST(SmoothTrack, DoesNotCrossACutOrAGap) {
  Clip clip(60);
  for (std::size_t i = 30; i < 60; ++i) {
    clip.track.frames[i].camera_from_head = TestPose(-20 + 0.1 * double(i), 8);
  }
  clip.cut_before[30] = true;
  clip.track.frames[45].found = false;
  const HeadTrack before = clip.track;
  SmoothTrack(clip.cut_before, clip.confidence, clip.track);
  for (std::size_t i = 0; i < 60; ++i) {
    if (!before.frames[i].found) continue;
    // Steady turns on both sides pass unchanged up to the rounding of the solver.
    EXPECT_LT(AngleDeg(clip.track.frames[i].camera_from_head.linear(),
                       before.frames[i].camera_from_head.linear()),
              1e-4)
        << i;
  }
}

TEST(SmoothTrack, BridgesAFrameThatIsNotToBeTrusted) {
  Clip clip(60);
  clip.track.frames[20].camera_from_head = TestPose(25, 20);
  clip.confidence[20] = 0.01;
  SmoothTrack(clip.cut_before, clip.confidence, clip.track);
  EXPECT_LT(AngleDeg(clip.track.frames[20].camera_from_head.linear(), TestPose(4).linear()), 1);
}

TEST(FollowExpression, MovesTheMeshToTheLandmarks) {
  Clip clip(12);
  clip.track.face.positions = {{0, 0, 10}, {20, -40, 0}, {-20, 10, 5}};
  std::vector<FaceLandmarks> landmarks(12);
  std::vector<const FaceLandmarks*> seen;
  for (std::size_t i = 0; i < 12; ++i) {
    for (std::size_t v = 0; v < 3; ++v) {
      // The second point (a mouth) is open by 5 mm.
      const Eigen::Vector3d open(0, v == 1 ? -5 : 0, 0);
      const Eigen::Vector2d px = clip.track.camera.Project(clip.track.frames[i].camera_from_head *
                                                           (clip.track.face.positions[v] + open));
      landmarks[i].points.emplace_back(px.x(), px.y(), 0);
    }
    seen.push_back(&landmarks[i]);
  }
  FollowExpression(seen, clip.cut_before, clip.track);
  for (std::size_t i = 0; i < 12; ++i) {
    const TrackedFrame& frame = clip.track.frames[i];
    ASSERT_EQ(frame.vertices.size(), 3u);
    for (std::size_t v = 0; v < 3; ++v) {
      const Eigen::Vector2d px =
          clip.track.camera.Project(frame.camera_from_head * frame.vertices[v].cast<double>());
      // The change is constant but for perspective, which floats and smoothing keep to this.
      EXPECT_LT((px - landmarks[i].points[v].head<2>()).norm(), 0.01);
    }
    // 5 mm are 12.5 px at 600 mm; one point of three.
    EXPECT_NEAR(double(frame.residual_px), 12.5 / std::sqrt(3.0), 0.3);
  }
}

}  // namespace
}  // namespace lorgnette
