// SPDX-License-Identifier: Apache-2.0
#include "tracking/drift_limit.h"

#include <gtest/gtest.h>

#include "base/units.h"

namespace lorgnette {
namespace {

constexpr double kMost = RadiansFromDegrees(3);
constexpr std::size_t kFrames = 22;

Eigen::Isometry3d Turned(double yaw_deg, double x_mm = 0) {
  Eigen::Isometry3d pose(Eigen::AngleAxisd(RadiansFromDegrees(yaw_deg), Eigen::Vector3d::UnitY()));
  pose.translation() = Eigen::Vector3d(x_mm, 0, 600);
  return pose;
}

double Apart(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return MotionBetween(a, b).head<3>().norm();
}

// A head that turns by 20 degrees; landmarks that err by 1 degree at its beginning and 2 at its
// end; texture that follows it with `gain` between two good frames.
struct DriftingClip {
  explicit DriftingClip(double gain) {
    for (std::size_t f = 0; f < kFrames; ++f) {
      const double share = double(f) / double(kFrames - 1), yaw = 20 * share;
      truth.push_back(Turned(yaw));
      landmarks.push_back(Turned(yaw + 1 + share));
      const bool good = f == 0 || f + 1 == kFrames;
      poses.emplace_back();
      poses.back().emplace();
      poses.back()->camera_from_head = good ? truth.back() : Turned(gain * yaw, yaw);
    }
  }
  std::vector<Eigen::Isometry3d> truth, landmarks;
  std::vector<std::optional<PoseFit>> poses;
};

TEST(DriftLimit, HoldsPosesBetweenTwoGoodFrames) {
  DriftingClip clip(0.4);
  LimitDrift(clip.landmarks, 1, kFrames - 1, true, true, kMost, clip.poses);
  for (std::size_t f = 0; f < kFrames; ++f) {
    EXPECT_LE(Apart(clip.truth[f], clip.poses[f]->camera_from_head), kMost + 1e-3) << f;
  }
  // Where 12 degrees were lost, of 20 mm of shift a quarter is left too.
  EXPECT_NEAR(clip.poses[kFrames - 2]->camera_from_head.translation().x(), 5, 0.5);
}

TEST(DriftLimit, LeavesWhatIsNearAndWhatIsMissing) {
  DriftingClip clip(0.9);
  clip.poses[5].reset();
  const auto before = clip.poses;
  LimitDrift(clip.landmarks, 1, kFrames - 1, true, true, kMost, clip.poses);
  EXPECT_FALSE(clip.poses[5]);
  for (std::size_t f = 0; f < kFrames; ++f) {
    if (f == 5) continue;
    EXPECT_TRUE(clip.poses[f]->camera_from_head.isApprox(before[f]->camera_from_head)) << f;
  }
}

TEST(DriftLimit, OneGoodFrameGivesTheCorrectionAlone) {
  for (const bool before : {true, false}) {
    DriftingClip clip(0.4);
    LimitDrift(clip.landmarks, 1, kFrames - 1, before, !before, kMost, clip.poses);
    for (std::size_t f = 1; f + 1 < kFrames; ++f) {
      EXPECT_LE(Apart(clip.truth[f], clip.poses[f]->camera_from_head),
                kMost + RadiansFromDegrees(1) + 1e-3)
          << f;
    }
  }
  DriftingClip clip(0.4);
  LimitDrift(clip.landmarks, 1, kFrames - 1, false, false, kMost, clip.poses);
  EXPECT_GT(Apart(clip.truth[20], clip.poses[20]->camera_from_head), RadiansFromDegrees(11));
}

}  // namespace
}  // namespace lorgnette
