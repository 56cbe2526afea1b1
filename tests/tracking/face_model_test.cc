// SPDX-License-Identifier: Apache-2.0
#include "tracking/face_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "tests/tracking/synthetic_face.h"
#include "tracking/clip_fit.h"
#include "tracking/focal_prior.h"

namespace lorgnette {
namespace {

using test::AngleDeg;
using test::SyntheticCanonical;
using test::TestCamera;
using test::TestPose;

FaceLandmarks Seen(const std::vector<Eigen::Vector3d>& head, const Eigen::Isometry3d& pose) {
  FaceLandmarks landmarks;
  for (const Eigen::Vector3d& p : head) {
    const Eigen::Vector2d px = TestCamera().Project(pose * p);
    landmarks.points.emplace_back(px.x(), px.y(), 0);
  }
  return landmarks;
}

TEST(HeadFromPoints, PutsThePupilsApartAndTheFaceUpright) {
  const CanonicalMesh canonical = SyntheticCanonical();
  std::vector<Eigen::Vector3d> points;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (const Eigen::Vector3d& p : canonical.mesh.positions) {
    points.push_back(0.7 * turn * p + Eigen::Vector3d(5, 6, 7));
  }
  const Similarity head = HeadFromPoints(points, canonical, 62);
  EXPECT_TRUE(head.rotation.isApprox(turn.transpose(), 1e-9));
  for (Eigen::Vector3d& p : points) p = head(p);
  const Pupils pupils = PupilsOf(points);
  EXPECT_NEAR(pupils.distance(), 62, 1e-9);
  EXPECT_LT((pupils.right + pupils.left).norm(), 1e-9);
  EXPECT_LT((pupils.left - Eigen::Vector3d(31, 0, 0)).norm(), 1e-9);
}

TEST(Similarity, RebasedSeesTheSamePicture) {
  Similarity s;
  s.scale = 1.07;
  s.rotation = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  s.shift = {1, -2, 3};
  const Eigen::Isometry3d pose = TestPose(14, 3);
  const Eigen::Vector3d p(20, -30, 15);
  const Eigen::Vector2d before = TestCamera().Project(pose * p);
  const Eigen::Vector2d after = TestCamera().Project(s.Rebased(pose) * s(p));
  EXPECT_LT((before - after).norm(), 1e-9);
}

TEST(FitFace, FindsPosesOfTheCanonicalFace) {
  const CanonicalMesh canonical = SyntheticCanonical();
  const std::vector<Eigen::Vector3d> head = CanonicalHead(canonical, 64);
  const std::vector<Eigen::Isometry3d> truth{TestPose(0), TestPose(15), TestPose(-10, 5)};
  std::vector<FaceLandmarks> seen;
  for (const Eigen::Isometry3d& pose : truth) seen.push_back(Seen(head, pose));
  std::vector<Eigen::Isometry3d> poses;
  const auto found =
      FitFace(TestCamera(), canonical, {&seen[0], nullptr, &seen[1], &seen[2]}, 64, poses);
  // The canonical face is the prior's own centre: nothing pulls away from the truth.
  EXPECT_LT(AngleDeg(poses[0].linear(), truth[0].linear()), 0.01);
  EXPECT_LT(AngleDeg(poses[2].linear(), truth[1].linear()), 0.01);
  EXPECT_LT((poses[3].translation() - truth[2].translation()).norm(), 0.05);
  for (std::size_t i = 0; i < head.size(); ++i) EXPECT_LT((found[i] - head[i]).norm(), 0.05) << i;
}

TEST(FitFace, PersonalisesTheFace) {
  const CanonicalMesh canonical = SyntheticCanonical();
  std::vector<Eigen::Vector3d> head = CanonicalHead(canonical, 64);
  for (Eigen::Vector3d& p : head) p.y() *= 1.06;  // a longer face
  const FaceLandmarks seen = Seen(head, TestPose(0));
  std::vector<Eigen::Isometry3d> poses;
  const auto found = FitFace(TestCamera(), canonical, {&seen}, 64, poses);
  double worst = 0;
  for (std::size_t i = 0; i < head.size(); ++i) {
    const Eigen::Vector2d px = TestCamera().Project(poses[0] * found[i]);
    worst = std::max(worst, (px - seen.points[i].head<2>()).norm());
  }
  // The prior's sigma of 20 mm against the landmarks' 2 mm leaves a hundredth of the change, which
  // is at most 5 mm or 13 px.
  EXPECT_LT(worst, 0.3);
}

TEST(YawOffset, RecoversTheConstantUnderAGainOfItsOwn) {
  std::vector<double> texture, network;
  for (int i = -20; i <= 20; ++i) {
    const double yaw = RadiansFromDegrees(i);
    texture.push_back(yaw - 0.05);
    network.push_back(1.22 * yaw);
  }
  EXPECT_NEAR(YawOffset(texture, network), 0.05, 1e-6);
}

TEST(YawOffset, TakesTheUsualGainFromATurnedStill) {
  EXPECT_NEAR(YawOffset({0.2}, {0.3}), 0.3 / kNetworkYawGain - 0.2, 1e-12);
}

TEST(TypicalFocal, IsExactWhereBothHabitsAgree) {
  const double focal = 480 / std::tan(RadiansFromDegrees(kTypicalFieldDeg) / 2);
  const auto faces = [&](double size) {
    FaceLandmarks f;
    for (const Eigen::Vector3d& p : CanonicalHead(SyntheticCanonical(), 64)) {
      f.points.push_back(size * focal / kTypicalDistanceMm * p);
    }
    return f;
  };
  const FaceLandmarks usual = faces(1), large = faces(2);
  EXPECT_NEAR(TypicalFocal(960, 720, 64, {nullptr, &usual}), focal, 1e-6 * focal);
  const double longer = TypicalFocal(960, 720, 64, {&large});
  EXPECT_GT(longer, 1.3 * focal);
  EXPECT_LT(longer, 2 * focal);
}

TEST(RigidWeights, TrustTheNoseBridgeAndNotTheMouth) {
  const auto w = RigidWeights({{0, 30, 55}, {12, -45, 50}, {-12, -45, 50}, {70, 10, -20}});
  EXPECT_GT(w[0], 0.8);
  EXPECT_LT(w[1], 0.01);
  EXPECT_EQ(w[1], w[2]);
  EXPECT_LT(w[3], 0.01);
}

TEST(ReadCanonicalMesh, RefusesOtherMeshesWithTheReason) {
  const std::string path = ::testing::TempDir() + "face.obj";
  const auto complaint = [&](const std::string& text) {
    EXPECT_TRUE(WriteFileAtomically(path, text));
    const auto mesh = ReadCanonicalMesh(path);
    return mesh ? std::string("accepted") : mesh.error().message;
  };
  EXPECT_THAT(complaint("v 0 0 0\n"), ::testing::HasSubstr("got 1 vertices and 0 triangles"));
  EXPECT_THAT(complaint("v 0 0\n"), ::testing::HasSubstr("face.obj:1: got 'v 0 0'"));
  EXPECT_THAT(complaint("f 1 2 3\n"), ::testing::HasSubstr("want numbers after 'f'"));
  EXPECT_FALSE(ReadCanonicalMesh("/nonexistent.obj"));
}

}  // namespace
}  // namespace lorgnette
