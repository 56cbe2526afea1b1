// SPDX-License-Identifier: Apache-2.0
#include "tracking/portraits.h"

#include <gtest/gtest.h>

#include "tests/tracking/synthetic_face.h"

namespace lorgnette {
namespace {

// As the network would see the face, far away: depth in pixels, away from the camera positive.
FaceLandmarks Seen(const CanonicalMesh& canonical, double yaw_deg, double pitch_deg = 0) {
  const Eigen::Isometry3d pose = test::TestPose(yaw_deg, pitch_deg);
  FaceLandmarks landmarks;
  for (const Eigen::Vector3d& p : canonical.mesh.positions) {
    landmarks.points.push_back(2 * (pose.linear() * p) + Eigen::Vector3d(320, 240, 0));
  }
  return landmarks;
}

TEST(ApparentTurn, IsTheAngleToTheLineOfSight) {
  const CanonicalMesh canonical = test::SyntheticCanonical();
  for (const double yaw : {-31.0, -4.0, 12.0}) {
    EXPECT_NEAR(DegreesFromRadians(ApparentTurn(Seen(canonical, yaw), canonical)), std::abs(yaw),
                1e-6);
  }
  EXPECT_NEAR(DegreesFromRadians(ApparentTurn(Seen(canonical, 0, 9), canonical)), 9, 1e-6);
}

TEST(Portraits, AreTheMostFrontalFramesInOrderOfTime) {
  const CanonicalMesh canonical = test::SyntheticCanonical();
  const ImageRgb8 image(640, 480);
  Portraits portraits;
  for (std::size_t f = 0; f < 40; ++f) {
    portraits.Offer(f, image, Seen(canonical, 2 * (double(f) - 10)), canonical);
  }
  const std::vector<const Portrait*> chosen = portraits.MostFrontal(5);
  ASSERT_EQ(chosen.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(chosen[k]->frame, 8 + k);
  EXPECT_FALSE(chosen[0]->picture.empty());
  EXPECT_EQ(portraits.MostFrontal(100).size(), 40u);
}

TEST(Portraits, AreSpreadOverALongClipAndFew) {
  const CanonicalMesh canonical = test::SyntheticCanonical();
  const ImageRgb8 image(320, 240);
  Portraits portraits;
  // Turned aside, but for one frame in ten.
  for (std::size_t f = 0; f < 1000; ++f) {
    portraits.Offer(f, image, Seen(canonical, f % 10 == 3 ? 1 : 20), canonical);
  }
  const std::vector<const Portrait*> kept = portraits.MostFrontal(1000);
  EXPECT_LE(kept.size(), 64u);
  EXPECT_GT(kept.size(), 32u);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    EXPECT_EQ(kept[k]->frame % 10, 3u);
    if (k == 0) continue;
    // At most one a stretch of 16 frames, so that two are within two stretches.
    EXPECT_LE(kept[k]->frame - kept[k - 1]->frame, 32u);
  }
}

TEST(Portraits, AreNoneWithoutAFace) { EXPECT_TRUE(Portraits().MostFrontal(8).empty()); }

}  // namespace
}  // namespace lorgnette
