// SPDX-License-Identifier: Apache-2.0
#include "geometry/fit.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "geometry/assemble.h"
#include "geometry/face_relief.h"
#include "geometry/frame_io.h"
#include "geometry/head_occluder.h"
#include "geometry/parametric_frame.h"
#include "optics/base_curve.h"

namespace lorgnette {
namespace {

// A face of our own making: a forehead and cheeks on a wide cylinder, and a straight nose whose
// ridge comes forward downward, with flanks that slope like a real bridge (reference: mean adult,
// bridge 17 mm wide 8 mm behind its ridge).
double SkinHeight(double x, double y) {
  const double face = -x * x / 110;
  const double ridge = 10.0 - 0.55 * std::min(y - 8, 0.0) + 0.25 * std::max(y - 8, 0.0);
  const double flank = std::sqrt(x * x + 9) - 3;  // round ridge, then straight flanks
  const double width = 1.9 + 0.012 * std::min(y, 0.0);
  return std::max(face, ridge - width * flank);
}

TriangleMesh MadeFace() {
  TriangleMesh mesh;
  constexpr int kColumns = 141, kRows = 121;  // 1 mm apart
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const double x = i - 70, y = j - 70;
      mesh.positions.emplace_back(x, y, SkinHeight(x, y));
    }
  }
  for (int j = 0; j + 1 < kRows; ++j) {
    for (int i = 0; i + 1 < kColumns; ++i) {
      const int a = j * kColumns + i;
      mesh.triangles.emplace_back(a, a + 1, a + kColumns);
      mesh.triangles.emplace_back(a + 1, a + kColumns + 1, a + kColumns);
    }
  }
  ComputeVertexNormals(mesh);
  return mesh;
}

const Eigen::Vector3d kRight(-32, 0, 0), kLeft(32, 0, 0);

TEST(FaceRelief, IsExactOnAPlane) {
  TriangleMesh plane;
  plane.positions = {{-60, -60, 0}, {60, -60, 12}, {60, 60, 18}, {-60, 60, 6}};
  plane.triangles = {{0, 1, 2}, {0, 2, 3}};
  const FaceRelief relief(plane);
  EXPECT_NEAR(relief.Height(10.3, -20.7).value(), 9 + 0.1 * 10.3 - 0.05 * 20.7, 1e-5);
  EXPECT_FALSE(relief.Height(70, 0).has_value());
  const Eigen::Vector3d normal = relief.Normal(0, 0).value();
  EXPECT_NEAR((normal - Eigen::Vector3d(-0.1, -0.05, 1).normalized()).norm(), 0, 1e-4);
}

class Fits : public testing::TestWithParam<const char*> {};

TEST_P(Fits, RestOnTheNoseTouchingBothSidesAlike) {
  const FrameModel frame = *LoadFrame(GetParam());
  const auto fit = PlaceOnFace(frame, MadeFace(), kRight, kLeft);
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  EXPECT_LE(fit->wearing.nose_penetration_mm, 0.5);
  EXPECT_LE(fit->wearing.nose_gap_mm, 0.5);
  EXPECT_NEAR(fit->head_from_frame.translation().x(), 0, 0.05);  // the face is symmetric
  EXPECT_NEAR(fit->wearing.fitting_height_right_mm, fit->wearing.fitting_height_left_mm, 0.02);
  EXPECT_GT(fit->wearing.fitting_height_right_mm, -1);
  EXPECT_LT(fit->wearing.fitting_height_right_mm, 9);
  EXPECT_GT(fit->wearing.pantoscopic_tilt_deg, 1);
  EXPECT_LT(fit->wearing.pantoscopic_tilt_deg, 17);
}

INSTANTIATE_TEST_SUITE_P(All, Fits,
                         testing::Values("rectangle", "panto", "cat-eye", "round", "aviator",
                                         "hexagon"),
                         [](const auto& shown) {
                           std::string name = shown.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(PlaceOnFace, FollowsAFaceThatIsMovedSideways) {
  const FrameModel frame = *LoadFrame("rectangle");
  TriangleMesh face = MadeFace();
  for (Eigen::Vector3d& p : face.positions) p.x() += 1.5;
  const auto fit = PlaceOnFace(frame, face, kRight, kLeft);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->head_from_frame.translation().x(), 1.5, 0.1);
}

TEST(FitEyewear, NotesTheVertexDistanceThatItReports) {
  Prescription rx;
  rx.right.sphere = rx.left.sphere = Diopters(-8);
  FitOptions options;
  options.min_vertex_mm = 25;  // none so far
  options.max_vertex_mm = 26;
  const auto fitted =
      FitEyewear(*LoadFrame("panto"), MadeFace(), kRight, kLeft, rx, options, EyewearOptions{});
  ASSERT_TRUE(fitted.has_value()) << fitted.error().message;
  const WearingPosition& wearing = fitted->eyewear.wearing;
  const double mean = (wearing.vertex_distance_right_mm + wearing.vertex_distance_left_mm) / 2;
  EXPECT_THAT(wearing.notes, testing::Contains(testing::HasSubstr(
                                 fmt::format("vertex distance {:.1f} mm, want 25 to 26", mean))));
}

TEST(PlaceOnFace, NudgeMovesByExactlyThat) {
  const FrameModel frame = *LoadFrame("round");
  const TriangleMesh face = MadeFace();
  FitOptions options;
  const auto before = PlaceOnFace(frame, face, kRight, kLeft, options);
  options.nudge_mm = {0.5, -2, 1};
  const auto after = PlaceOnFace(frame, face, kRight, kLeft, options);
  ASSERT_TRUE(before.has_value() && after.has_value());
  const Eigen::Vector3d moved =
      after->head_from_frame.translation() - before->head_from_frame.translation();
  EXPECT_NEAR((moved - options.nudge_mm).norm(), 0, 1e-12);
}

TEST(PlaceOnFace, RefusesAFaceWithoutANose) {
  TriangleMesh forehead;
  forehead.positions = {{-40, 60, 0}, {40, 60, 0}, {0, 75, 0}};
  forehead.triangles = {{0, 1, 2}};
  const auto fit = PlaceOnFace(*LoadFrame("round"), forehead, kRight, kLeft);
  ASSERT_FALSE(fit.has_value());
  EXPECT_THAT(fit.error().message, testing::HasSubstr("nose"));
}

TEST(MakeEyewear, PutsOpticalCentresBeforeThePupilsAndMeasuresTheVertexDistance) {
  const FrameModel frame = *LoadFrame("panto");
  const auto fit = PlaceOnFace(frame, MadeFace(), kRight, kLeft);
  ASSERT_TRUE(fit.has_value());
  Prescription rx;
  rx.right.sphere = Diopters(-4.25);
  rx.right.cylinder = Diopters(-0.75);
  rx.right.axis = AxisDegrees(160);
  rx.left.sphere = Diopters(-4.5);
  EyewearOptions options;
  options.medium.index_d = 1.6;
  const auto eyewear = MakeEyewear(*fit, rx, kRight, kLeft, options);
  ASSERT_TRUE(eyewear.has_value()) << eyewear.error().message;
  for (const auto& [lens, opening, pupil] : {std::tuple(&eyewear->right, &fit->frame.right, kRight),
                                             std::tuple(&eyewear->left, &fit->frame.left, kLeft)}) {
    // The line of sight meets the opening's plane where the lens axis does.
    const Eigen::Isometry3d head_from_opening = fit->head_from_frame * opening->frame_from_opening;
    const Eigen::Vector3d vertex =
        fit->head_from_frame * (lens->frame_from_lens * Eigen::Vector3d::Zero());
    const Eigen::Vector3d axis = head_from_opening.linear().col(2);
    const double t = axis.dot(head_from_opening.translation() - pupil) / axis.z();
    const Eigen::Vector3d sight = pupil + t * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d offset = vertex - sight;
    EXPECT_NEAR((offset - offset.dot(axis) * axis).norm(), 0, 1e-9);
  }
  EXPECT_EQ(eyewear->right.lens.design().order.rx.sphere.value(), -4.25);
  EXPECT_EQ(eyewear->left.lens.design().order.rx.sphere.value(), -4.5);
  EXPECT_GT(eyewear->wearing.vertex_distance_right_mm, 5);
  EXPECT_LT(eyewear->wearing.vertex_distance_right_mm, 25);
}

TEST(MakeEyewear, ChoosesFrontsWhoseBevelsFollowTheRims) {
  FrameParameters flat = *LoadFrame("panto")->parameters;
  flat.frame_curve_diopters = 0.5;
  const auto fit = PlaceOnFace(BuildFrame(flat), MadeFace(), kRight, kLeft);
  ASSERT_TRUE(fit.has_value());
  Prescription rx;
  rx.right.sphere = Diopters(-0.5);
  rx.left.sphere = Diopters(-0.75);
  EyewearOptions options;
  options.medium.index_d = 1.6;
  const Diopters by_rule[] = {VogelBaseCurve(rx.right.sphere), VogelBaseCurve(rx.left.sphere)};
  options.base_curves = {by_rule[0], by_rule[1]};
  const auto given = MakeEyewear(*fit, rx, kRight, kLeft, options);
  options.base_curves = {};
  const auto chosen = MakeEyewear(*fit, rx, kRight, kLeft, options);
  ASSERT_TRUE(given.has_value() && chosen.has_value());
  const auto misfit = [](const Eyewear& eyewear) {
    return std::max(eyewear.right.mount_misfit_mm, eyewear.left.mount_misfit_mm);
  };
  const auto front = [](const CutLens& lens) { return lens.lens.design().front_power; };
  ASSERT_GT(misfit(*given), kMisfitNote_mm);
  EXPECT_EQ(front(given->right), by_rule[0]);
  EXPECT_LT(given->right.rim_steeper_D, -2);
  EXPECT_LT(misfit(*chosen), misfit(*given) - kMisfitNote_mm);
  const double change = (front(chosen->right) - by_rule[0]).value();
  EXPECT_LT(change, 0);
  EXPECT_GE(change, -kMostBaseSteps * kBaseStep_D - 1e-12);
  EXPECT_NEAR(std::remainder(change, kBaseStep_D), 0, 1e-12);
  EXPECT_NEAR((front(chosen->left) - by_rule[1]).value(), change, 1e-12);
  EXPECT_THAT(chosen->wearing.notes,
              testing::Contains(testing::HasSubstr("in place of the rule's 5.75")));
}

TEST(MakeEyewear, NamesTheEyeWhoseLensFails) {
  const auto fit = PlaceOnFace(*LoadFrame("aviator"), MadeFace(), kRight, kLeft);
  ASSERT_TRUE(fit.has_value());
  EyewearOptions options;
  options.cut.blank_diameter_mm = 40;
  const auto eyewear = MakeEyewear(*fit, Prescription{}, kRight, kLeft, options);
  ASSERT_FALSE(eyewear.has_value());
  EXPECT_THAT(eyewear.error().message, testing::HasSubstr("right lens: cut: blank too small"));
}

TEST(BuildHeadOccluder, StaysBehindTheFaceAndReachesTheEars) {
  const TriangleMesh face = MadeFace();
  const EarPoints ears = EstimateEars(face, 64);
  const TriangleMesh head = BuildHeadOccluder(face, ears);
  ASSERT_FALSE(head.empty());
  const FaceRelief relief(face);
  double back = 0;
  for (const Eigen::Vector3d& p : head.positions) {
    back = std::min(back, p.z());
    const auto skin = relief.Height(p.x(), p.y());
    if (!skin || p.z() < -40) continue;
    EXPECT_LE(p.z(), *skin + 1e-3);
  }
  EXPECT_LT(back, -150);
}

TEST(BuildHeadOccluder, AWholeHeadNeedsNone) {
  TriangleMesh closed;
  closed.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  closed.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  EXPECT_TRUE(BuildHeadOccluder(closed, EarPoints{}).empty());
}

}  // namespace
}  // namespace lorgnette
