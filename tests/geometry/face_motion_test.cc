// SPDX-License-Identifier: Apache-2.0
#include "geometry/face_motion.h"

#include <gtest/gtest.h>

namespace lorgnette {
namespace {

// A face of single points at these distances below a pad at the origin of a frame that is worn 5 mm
// to the left.
constexpr double kDistances_mm[] = {0, 4, kHeld_mm, 15, 20, 25, kFree_mm, 60};

TEST(FaceMotion, HoldsTheSkinBelowThePadsAndLeavesTheRestItsMotion) {
  const Eigen::Isometry3d head_from_frame(Eigen::Translation3d(5, 0, 0));
  FrameModel frame;
  frame.nose_contacts.emplace_back(0, 0, 0);
  TriangleMesh face;
  for (const double d : kDistances_mm) face.positions.emplace_back(5, -d, 0);
  const FaceMotion motion(face, frame, head_from_frame);
  const Eigen::Vector3f shift(-3, 1, 2);
  std::vector<Eigen::Vector3f> moved;
  for (const Eigen::Vector3d& p : face.positions) moved.push_back(p.cast<float>() + shift);
  const std::vector<Eigen::Vector3f> held = motion.Held(moved);
  float before = 0;
  for (std::size_t i = 0; i < held.size(); ++i) {
    const Eigen::Vector3f kept = held[i] - face.positions[i].cast<float>();
    const float share = kept.dot(shift) / shift.squaredNorm();
    EXPECT_LT((kept - share * shift).norm(), 1e-5f);  // float sums of 60 mm
    if (kDistances_mm[i] <= kHeld_mm) {
      EXPECT_EQ(share, 0) << kDistances_mm[i];
    } else if (kDistances_mm[i] >= kFree_mm) {
      EXPECT_NEAR(share, 1, 1e-5) << kDistances_mm[i];
    }
    EXPECT_GE(share, before);
    before = share;
  }
}

TEST(FaceMotion, HoldsTheSkinBelowTheTemplesToo) {
  FrameModel frame;
  FramePart temple, front;
  temple.kind = FramePartKind::kTemple;
  temple.mesh.positions = {{70, 0, -40}};
  front.kind = FramePartKind::kFront;
  front.mesh.positions = {{30, 20, 0}};
  frame.parts = {temple, front};
  TriangleMesh face;
  face.positions = {{68, 0, -40}, {30, 18, -8}};
  const FaceMotion motion(face, frame, Eigen::Isometry3d::Identity());
  const auto held = motion.Held({{69, 0, -40}, {31, 18, -8}});
  EXPECT_EQ(held[0], Eigen::Vector3f(68, 0, -40));
  EXPECT_EQ(held[1], Eigen::Vector3f(31, 18, -8));  // a rim hangs before the brow
}

}  // namespace
}  // namespace lorgnette
