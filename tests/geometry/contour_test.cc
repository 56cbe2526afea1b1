// SPDX-License-Identifier: Apache-2.0
#include "geometry/contour.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "geometry/closed_curve.h"
#include "geometry/frame_io.h"

namespace lorgnette {
namespace {

double GreatestDistance(const Polygon2& from, const Polygon2& to) {
  double worst = 0;
  for (const Eigen::Vector2d& p : from) worst = std::max(worst, DistanceToBoundary(to, p));
  return worst;
}

class ShippedFrames : public testing::TestWithParam<const char*> {
 protected:
  static FrameModel Load() {
    Result<FrameModel> frame = LoadFrame(GetParam());
    EXPECT_TRUE(frame.has_value()) << frame.error().message;
    return *frame;
  }
};

TEST_P(ShippedFrames, TracedContoursAreTheTrueOnesWithinTheirBound) {
  const FrameModel frame = Load();
  const auto traced = TraceOpenings(PartsOfKind(frame, FramePartKind::kFront));
  ASSERT_TRUE(traced.has_value()) << traced.error().message;
  for (const auto& [truth, measured] :
       {std::pair(&frame.right, &traced->right), std::pair(&frame.left, &traced->left)}) {
    const double contour = GreatestDistance(measured->contour_mm, truth->contour_mm);
    const double aperture = GreatestDistance(measured->aperture_mm, truth->aperture_mm);
    EXPECT_LT(contour, kContourError_mm);
    EXPECT_LT(aperture, kContourError_mm);
    RecordProperty("contour_um", int(1000 * contour));
    RecordProperty("aperture_um", int(1000 * aperture));
    EXPECT_GT(SignedArea(measured->contour_mm), 0);
    const double off =
        (measured->frame_from_opening.translation() - truth->frame_from_opening.translation())
            .norm();
    EXPECT_LT(off, 2 * kContourError_mm);
  }
  EXPECT_NEAR(traced->boxing.a_mm, frame.boxing.a_mm, 2 * kContourError_mm);
  EXPECT_NEAR(traced->boxing.b_mm, frame.boxing.b_mm, 2 * kContourError_mm);
  EXPECT_NEAR(traced->boxing.dbl_mm, frame.boxing.dbl_mm, 4 * kContourError_mm);
  EXPECT_NEAR(traced->boxing.circumference_mm, frame.boxing.circumference_mm, 0.06);
  const double box = std::max({std::abs(traced->boxing.a_mm - frame.boxing.a_mm),
                               std::abs(traced->boxing.b_mm - frame.boxing.b_mm),
                               std::abs(traced->boxing.dbl_mm - frame.boxing.dbl_mm)});
  RecordProperty("box_um", int(1000 * box));
  RecordProperty("circumference_um", int(1000 * std::abs(traced->boxing.circumference_mm -
                                                         frame.boxing.circumference_mm)));
}

INSTANTIATE_TEST_SUITE_P(All, ShippedFrames,
                         testing::Values("rectangle", "panto", "cat-eye", "round", "aviator",
                                         "hexagon"),
                         [](const auto& shown) {
                           std::string name = shown.param;
                           std::erase(name, '-');
                           return name;
                         });

// A rim of rectangular section, 4 mm deep, whose wall toward the lens is flat.
TriangleMesh FlatWalledRim(const Eigen::Isometry3d& frame_from_rim) {
  TriangleMesh mesh;
  constexpr int kSides = 240;
  const double offsets[4][2] = {{0, -2}, {2, -2}, {2, 2}, {0, 2}};
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * kPi * i / kSides;
    for (const auto& o : offsets) {
      mesh.positions.push_back(frame_from_rim * Eigen::Vector3d((25 + o[0]) * std::cos(angle),
                                                                (19 + o[0]) * std::sin(angle),
                                                                o[1]));
    }
    for (int k = 0; k < 4; ++k) {
      const int a = 4 * i + k, b = 4 * i + (k + 1) % 4;
      const int c = 4 * ((i + 1) % kSides) + k, d = 4 * ((i + 1) % kSides) + (k + 1) % 4;
      mesh.triangles.emplace_back(a, c, d);
      mesh.triangles.emplace_back(a, d, b);
    }
  }
  ComputeVertexNormals(mesh);
  return mesh;
}

TEST(TraceOpenings, FindsThePlaneOfARimWithoutAGroove) {
  for (const double form_deg : {0.0, 2.0, 6.0}) {
    TriangleMesh front;
    for (const double side : {-1.0, 1.0}) {
      Append(front, FlatWalledRim(Eigen::Translation3d(side * 34, 0, 0) *
                                  Eigen::AngleAxisd(side * RadiansFromDegrees(form_deg),
                                                    Eigen::Vector3d::UnitY())));
    }
    const auto traced = TraceOpenings(front);
    ASSERT_TRUE(traced.has_value()) << traced.error().message;
    // Chords of 240 sides lie 2 um inside; half of a wall's height is told to that over 0.3 mm.
    EXPECT_NEAR(traced->face_form_deg, form_deg, 0.2);
    EXPECT_NEAR(traced->frame_curve_diopters, 0, 0.1);
    EXPECT_NEAR(traced->boxing.a_mm, 50, 0.1);
    for (const LensOpening* opening : {&traced->right, &traced->left}) {
      EXPECT_NEAR(opening->frame_from_opening.translation().z(), 0, 0.05);
      EXPECT_NEAR(opening->frame_from_opening.linear()(1, 2), 0, 0.003);
    }
  }
}

TEST(TraceOpenings, RefusesARimWithAGap) {
  FrameModel frame = *LoadFrame("round");
  TriangleMesh front;
  for (const FramePart& part : frame.parts) {
    if (part.name == "left rim") {
      TriangleMesh open = part.mesh;
      std::erase_if(open.triangles, [&](const Eigen::Vector3i& t) {
        return open.positions[std::size_t(t[0])].y() < -20;
      });
      Append(front, open);
    } else if (part.kind == FramePartKind::kFront) {
      Append(front, part.mesh);
    }
  }
  const auto traced = TraceOpenings(front);
  ASSERT_FALSE(traced.has_value());
  EXPECT_THAT(traced.error().message, testing::HasSubstr("no closed rim"));
}

TEST(TraceOpenings, RefusesAnEmptyMesh) { EXPECT_FALSE(TraceOpenings({}).has_value()); }

}  // namespace
}  // namespace lorgnette
