// SPDX-License-Identifier: Apache-2.0
#include "tracking/pose_fit.h"

#include <gtest/gtest.h>

#include "tests/tracking/synthetic_face.h"

namespace lorgnette {
namespace {

using test::AngleDeg;
using test::TestCamera;
using test::TestPose;

std::vector<PointSighting> Sightings(const Eigen::Isometry3d& pose) {
  std::vector<PointSighting> sightings;
  for (const Eigen::Vector3d& p : test::SyntheticCanonical().mesh.positions) {
    sightings.push_back({p, TestCamera().Project(pose * p), 1});
  }
  return sightings;
}

TEST(MotionBetween, IsUndoneByMoved) {
  const Eigen::Isometry3d a = TestPose(12, 3), b = TestPose(-20, 8);
  // A product of rotations in double: a few units in the last place of 600 mm.
  EXPECT_TRUE(Moved(a, MotionBetween(a, b)).isApprox(b, 1e-13));
  EXPECT_TRUE(Moved(a, Vector6d::Zero()).isApprox(a, 0));
}

TEST(FitPose, RecoversAnExactPose) {
  const Eigen::Isometry3d truth = TestPose(23, -7);
  const PoseFit fit = FitPose(TestCamera(), Sightings(truth), TestPose(0), 2);
  // Gauss-Newton stops at steps of 1e-7 radians and millimetres and converges quadratically.
  EXPECT_LT(AngleDeg(fit.camera_from_head.linear(), truth.linear()), 1e-5);
  EXPECT_LT((fit.camera_from_head.translation() - truth.translation()).norm(), 1e-5);
  EXPECT_LT(fit.rms_px, 1e-6);
}

TEST(FitPose, IsLittleMovedByAThirdOfOutliers) {
  const Eigen::Isometry3d truth = TestPose(10, 5);
  std::vector<PointSighting> sightings = Sightings(truth);
  for (std::size_t i = 0; i < sightings.size(); i += 3) sightings[i].pixel.x() += 60;
  const PoseFit fit = FitPose(TestCamera(), sightings, TestPose(5), 2);
  // The Cauchy loss leaves an outlier at 30 scales a pull of 1/30 of a scale: together less than
  // half a pixel, 0.2 mm here.
  EXPECT_LT((fit.camera_from_head.translation() - truth.translation()).head<2>().norm(), 0.2);
  EXPECT_LT(AngleDeg(fit.camera_from_head.linear(), truth.linear()), 0.5);
}

TEST(FitPose, KeepsTheGuessWithoutSightings) {
  const PoseFit fit = FitPose(TestCamera(), {}, TestPose(4), 2);
  EXPECT_TRUE(fit.camera_from_head.isApprox(TestPose(4), 1e-12));
  EXPECT_EQ(fit.inlier_weight, 0);
}

TEST(FitPose, ReturnsARotationEvenForNonsense) {
  std::vector<PointSighting> sightings = Sightings(TestPose(0));
  for (std::size_t i = 0; i < sightings.size(); ++i) sightings[i].pixel *= double(i % 7);
  const Eigen::Matrix3d r =
      FitPose(TestCamera(), sightings, TestPose(0), 2).camera_from_head.linear();
  EXPECT_TRUE((r.transpose() * r).isIdentity(1e-12));
}

}  // namespace
}  // namespace lorgnette
