// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>

#include "optics/front_form.h"
#include "optics/soft_progressive.h"

namespace lorgnette {
namespace {

constexpr double kIndex = 1.6;

SegmentOrder Segment(SegmentShape shape, double width) {
  SegmentOrder s;
  s.shape = shape;
  s.width_mm = width;
  return s;
}

Surface Front(const SegmentOrder& segment, Eye eye = Eye::kRight) {
  return *SegmentFront(segment, eye, Diopters(6), Diopters(2), kIndex);
}

// Published case 23: addition 2 over round 22 and 24, flat-top 28 (optical centre 5 mm down).
TEST(Bifocal, HasThePublishedJump) {
  EXPECT_NEAR(ImageJump(Segment(SegmentShape::kRound, 22), Diopters(2)).value(), 2.2, 1e-14);
  EXPECT_NEAR(ImageJump(Segment(SegmentShape::kRound, 24), Diopters(2)).value(), 2.4, 1e-14);
  EXPECT_NEAR(ImageJump(Segment(SegmentShape::kFlatTop, 28), Diopters(2)).value(), 1.0, 1e-14);
  EXPECT_NEAR(ImageJump(Segment(SegmentShape::kExecutive, 0), Diopters(2)).value(), 0, 0);
}

// The change of the surface's slope across the top is the jump, refracted: (n - 1) d(slope).
TEST(Bifocal, SurfaceHasTheJumpOfItsFormula) {
  for (const SegmentOrder& s :
       {Segment(SegmentShape::kRound, 22), Segment(SegmentShape::kFlatTop, 28),
        Segment(SegmentShape::kFlatTop, 35), Segment(SegmentShape::kExecutive, 0)}) {
    const Surface front = Front(s);
    const double x = -s.inset_mm, y = s.top_mm - 0.15;  // a round top lies a little lower
    const auto main = Surface(SphereSurface{10 / 1000.0}).Jet(x, y), segment = front.Jet(x, y);
    ASSERT_TRUE(main && segment);
    const double jump = 100 * (kIndex - 1) * std::abs(segment->zy - main->zy);
    // Slope against angle, and the normal's lean: third order in the segment's sagittal angle.
    EXPECT_NEAR(jump, ImageJump(s, Diopters(2)).value(), 0.05 * jump + 2 * 0.015);
  }
}

TEST(Bifocal, SegmentAddsExactlyTheAddition) {
  const Surface front = Front(Segment(SegmentShape::kFlatTop, 28));
  const auto far = FrontPowerAt(front, 0, 0, kIndex), near = FrontPowerAt(front, -2, -9, kIndex);
  EXPECT_NEAR(near->mean - far->mean, 2, 1e-11);
  EXPECT_NEAR(near->cylinder, 0, 1e-10);
}

// One-piece segments are flush along their circle: sag is continuous there, and jumps at a flat
// top.
TEST(Bifocal, IsFlushAlongItsCircleAndHasALedgeAtAFlatTop) {
  const SegmentOrder s = Segment(SegmentShape::kFlatTop, 28);
  const Surface front = Front(s);
  const auto& shape = std::get<BifocalSurface>(front.shape());
  const BifocalSurface::Frame frame = shape.SegmentFrame();
  const Eigen::Vector3d across = frame.normal.cross(Eigen::Vector3d::UnitX()).normalized();
  for (double a = 0.2; a < kPi - 0.2; a += 0.3) {  // the lower half of the circle
    const Eigen::Vector3d side = std::cos(a) * across.cross(frame.normal) - std::sin(a) * across;
    const Eigen::Vector3d p = frame.vertex + 14 * (side.y() < 0 ? side : Eigen::Vector3d(-side));
    const Eigen::Vector2d out = Eigen::Vector2d(p.x(), p.y()) - shape.center;
    const Eigen::Vector2d in = shape.center + out * (1 - 1e-9), beyond = shape.center + out * 1.001;
    ASSERT_TRUE(front.Jet(in.x(), in.y()) && front.Jet(beyond.x(), beyond.y()));
    EXPECT_NEAR(
        front.Jet(in.x(), in.y())->z,
        front.Jet(shape.center.x() + out.x() * (1 + 1e-9), shape.center.y() + out.y() * (1 + 1e-9))
            ->z,
        1e-7);
  }
  const double ledge = front.Jet(-2, s.top_mm + 1e-9)->z - front.Jet(-2, s.top_mm - 1e-9)->z;
  // e = (c_s - c) (r^2 - drop^2) / 2 to second order: 1/300 * (196 - 25) / 2 = 0.285 mm.
  EXPECT_NEAR(ledge, 0.285, 0.02);
}

TEST(Bifocal, RaysMeetTheSideTheyAimAt) {
  for (const SegmentOrder& s :
       {Segment(SegmentShape::kRound, 22), Segment(SegmentShape::kFlatTop, 28),
        Segment(SegmentShape::kExecutive, 0)}) {
    const Surface front = Front(s, Eye::kLeft);
    int hits = 0;
    for (double x = -15; x <= 15; x += 1.5) {
      for (double y = -18; y <= 6; y += 1.5) {
        const Eigen::Vector3d d = Eigen::Vector3d(0.05, -0.1, 1).normalized();
        const auto hit = front.Intersect({Eigen::Vector3d(x, y, 0) - 20 * d, d});
        if (!hit) continue;  // the ledge
        ++hits;
        EXPECT_NEAR(front.Jet(hit->point.x(), hit->point.y())->z, hit->point.z(), 1e-13);
      }
    }
    EXPECT_GT(hits, 350);
  }
}

TEST(Bifocal, InsetGoesTowardTheNose) {
  const SegmentOrder s = Segment(SegmentShape::kRound, 24);
  EXPECT_LT(std::get<BifocalSurface>(Front(s, Eye::kRight).shape()).center.x(), 0);
  EXPECT_GT(std::get<BifocalSurface>(Front(s, Eye::kLeft).shape()).center.x(), 0);
}

TEST(Bifocal, RefusesASegmentWithoutSag) {
  SegmentOrder s = Segment(SegmentShape::kRound, 90);
  const auto front = SegmentFront(s, Eye::kRight, Diopters(12), Diopters(3), 1.5);
  ASSERT_FALSE(front);
  EXPECT_THAT(front.error().message, testing::HasSubstr("possible"));
}

TEST(Progressive, ReachesTheAdditionAtTheInsetNearPoint) {
  const ProgressiveOrder order;
  for (const Eye eye : {Eye::kRight, Eye::kLeft}) {
    const Surface s = *ProgressiveFront(order, eye, Diopters(5), Diopters(2), kIndex, 25);
    const Eigen::Vector2d near = NearPoint(order, eye);
    const auto power = FrontPowerAt(s, near.x(), near.y(), kIndex);
    ASSERT_TRUE(power);
    EXPECT_NEAR(power->mean, 7, 1e-9);
    EXPECT_NEAR(FrontPowerAt(s, 0, 0, kIndex)->mean, 5, 1e-11);
    EXPECT_LT(power->cylinder, 1e-5);  // the root of rounding: an umbilic point
  }
}

TEST(SoftProgressive, HasLessUnwantedAstigmatismForTheSameAdditionAndCorridor) {
  ProgressiveOrder order;
  const Eigen::Vector2d near = NearPoint(order, Eye::kRight);
  const Surface hard = *ProgressiveFront(order, Eye::kRight, Diopters(5), Diopters(2), kIndex, 25);
  order.design = ProgressiveDesign::kSoft;
  const auto soft = ProgressiveFront(order, Eye::kRight, Diopters(5), Diopters(2), kIndex, 25);
  ASSERT_TRUE(soft) << soft.error().message;
  const ProgressiveZones a = ZonesOf(hard, near, kIndex), b = ZonesOf(*soft, near, kIndex);
  for (const auto& [name, z] : {std::pair{"hard", a}, std::pair{"soft", b}}) {
    std::cout << name << ": worst cylinder " << z.worst_cylinder_D << " D, clear width far "
              << z.far_width_mm << ", corridor " << z.corridor_width_mm << ", near "
              << z.near_width_mm << " mm, addition " << z.addition_D << " D\n";
  }
  EXPECT_LT(b.worst_cylinder_D, (1 - kSoftLeastGain) * a.worst_cylinder_D);
  EXPECT_NEAR(b.addition_D, 2, 0.12);  // ANSI's tolerance on the addition
  EXPECT_GT(b.near_width_mm, 4);
  const SurfaceJet vertex = *soft->Jet(0, 0);
  EXPECT_NEAR(vertex.z, 0, 1e-9);
  EXPECT_NEAR(vertex.zx, 0, 1e-9);
  EXPECT_NEAR(vertex.zy, 0, 1e-9);
}

}  // namespace
}  // namespace lorgnette
