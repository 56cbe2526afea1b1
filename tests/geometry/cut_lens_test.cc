// SPDX-License-Identifier: Apache-2.0
#include "geometry/cut_lens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "geometry/closed_curve.h"
#include "geometry/frame_io.h"
#include "geometry/lens_mesh.h"
#include "geometry/mesh_check.h"

namespace lorgnette {
namespace {

CertifiedLens Make(double sphere, double cylinder, const std::vector<Eigen::Vector2d>& contour) {
  LensOrder order;
  order.rx.sphere = Diopters(sphere);
  order.rx.cylinder = Diopters(cylinder);
  order.rx.axis = AxisDegrees(30);
  order.medium.index_d = 1.6;
  order.contour_mm = contour;
  const auto design = DesignLens(order);
  EXPECT_TRUE(design.has_value()) << design.error().message;
  const auto certified = Certify(*design);
  EXPECT_TRUE(certified.has_value()) << certified.error().message;
  return *certified;
}

LensOpening RoundOpening(double diameter_mm) {
  LensOpening opening;
  for (int k = 0; k < 720; ++k) {
    const double a = 2 * kPi * k / 720;
    opening.contour_mm.emplace_back(diameter_mm / 2 * std::cos(a), diameter_mm / 2 * std::sin(a));
  }
  return opening;
}

// Volume under a spherical cap of sag z and curvature c: pi z^2 (1/c - z/3).
double CapVolume(double c, double radius) {
  if (c == 0) return 0;
  const double z = c * radius * radius / (1 + std::sqrt(1 - c * c * radius * radius));
  return kPi * z * z * (1 / c - z / 3);
}

TEST(ContourInLensFrame, MirrorsXAndStaysCounterClockwise) {
  const std::vector<Eigen::Vector2d> contour = {{10, 0}, {0, 8}, {-12, 0}, {0, -9}};
  const auto lens = ContourInLensFrame(contour, {2, 1});
  EXPECT_GT(SignedArea(lens), 0);
  EXPECT_THAT(lens, testing::Contains(Eigen::Vector2d(-8, -1)));  // the temporal point, left eye
}

TEST(CutAndMount, MeshIsClosedAndFreeOfSelfIntersectionOnEveryFrame) {
  for (const char* name : {"rectangle", "panto", "cat-eye", "round", "aviator", "hexagon"}) {
    const FrameModel frame = *LoadFrame(name);
    for (const double sphere : {-6.0, 4.0}) {
      const Eigen::Vector2d centre(-2.5, 3);
      const auto contour = ContourInLensFrame(frame.left.contour_mm, centre);
      const auto cut = CutAndMount(Make(sphere, -1.5, contour), frame.left, centre);
      ASSERT_TRUE(cut.has_value()) << name << ": " << cut.error().message;
      const MeshReport report = CheckMesh(cut->mesh, true);
      EXPECT_TRUE(report.closed()) << name;
      EXPECT_EQ(report.components, 1);
      EXPECT_EQ(report.self_intersections, 0) << name << " " << sphere;
      EXPECT_GT(report.volume_mm3, 0);
    }
  }
}

TEST(CutAndMount, VolumeOfARoundFlatEdgedLensIsTheClosedForm) {
  const LensOpening opening = RoundOpening(50);
  for (const double sphere : {-8.0, -2.0, 0.0, 3.0, 6.0}) {
    const CertifiedLens lens = Make(sphere, 0, ContourInLensFrame(opening.contour_mm, {0, 0}));
    CutOptions options;
    options.edge = EdgeForm::kFlat;
    const auto cut = CutAndMount(lens, opening, {0, 0}, options);
    ASSERT_TRUE(cut.has_value()) << cut.error().message;
    const double front = std::get<SphereSurface>(lens.lens().front.shape()).curvature;
    const double back = std::get<SphereSurface>(lens.lens().back.shape()).curvature;
    // Cylinder between the vertex planes, less the front's cap, plus the back's.
    const double radius = 25;
    const auto under = [&](double c) {  // between the vertex plane and the surface
      const double z =
          c == 0 ? 0 : c * radius * radius / (1 + std::sqrt(1 - c * c * radius * radius));
      return kPi * radius * radius * z - CapVolume(c, radius);
    };
    const double closed_form =
        kPi * radius * radius * lens.lens().center_thickness_mm - under(front) + under(back);
    const double volume = CheckMesh(cut->mesh, false).volume_mm3;
    EXPECT_NEAR(volume / closed_form, 1, 1e-3) << sphere;
  }
}

TEST(CutAndMount, NormalsAreThoseOfTheSurfaces) {
  const LensOpening opening = RoundOpening(50);
  const CertifiedLens lens = Make(-4, -2, ContourInLensFrame(opening.contour_mm, {0, 0}));
  const auto cut = CutAndMount(lens, opening, {0, 0});
  ASSERT_TRUE(cut.has_value());
  int compared = 0;
  for (std::size_t i = 0; i < cut->mesh.positions.size(); ++i) {
    const Eigen::Vector3d &p = cut->mesh.positions[i], &n = cut->mesh.normals[i];
    if (p.head<2>().norm() > 23) continue;
    const auto hit =
        n.z() < 0 ? FrontHit(lens.lens(), p.head<2>()) : BackHit(lens.lens(), p.head<2>());
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR((hit->point - p).norm(), 0, 1e-12);
    EXPECT_NEAR(std::abs(hit->normal.dot(n)), 1, 1e-12);
    ++compared;
  }
  EXPECT_GT(compared, 500);
}

TEST(CutAndMount, AFlatGrooveSeatsARoundLensWithoutMisfit) {
  const LensOpening opening = RoundOpening(46);
  const CertifiedLens lens = Make(-3, 0, ContourInLensFrame(opening.contour_mm, {0, 0}));
  const auto cut = CutAndMount(lens, opening, {0, 0});
  ASSERT_TRUE(cut.has_value());
  EXPECT_LT(cut->mount_misfit_mm, 1e-9);
  // The back vertex lies on the eye's side of the front vertex.
  const Eigen::Vector3d front = cut->frame_from_lens * Eigen::Vector3d(0, 0, 0);
  const Eigen::Vector3d back =
      cut->frame_from_lens * Eigen::Vector3d(0, 0, lens.lens().center_thickness_mm);
  EXPECT_NEAR(front.z() - back.z(), lens.lens().center_thickness_mm, 1e-12);
}

TEST(CutAndMount, OpticalCentreLiesWhereItWasAskedFor) {
  const FrameModel frame = *LoadFrame("aviator");
  const Eigen::Vector2d centre(-3.5, 4);
  const auto contour = ContourInLensFrame(frame.left.contour_mm, centre);
  const auto cut = CutAndMount(Make(-4, 0, contour), frame.left, centre);
  ASSERT_TRUE(cut.has_value());
  const Eigen::Vector3d in_opening =
      frame.left.frame_from_opening.inverse() * (cut->frame_from_lens * Eigen::Vector3d(0, 0, 0));
  EXPECT_NEAR((in_opening.head<2>() - centre).norm(), 0, 1e-12);
}

TEST(CutAndMount, ABevelFollowsTheRimWhereTheEdgeIsThickEnough) {
  const FrameModel frame = *LoadFrame("aviator");
  const Eigen::Vector2d centre(-3.5, 4);
  const auto contour = ContourInLensFrame(frame.left.contour_mm, centre);
  const CertifiedLens lens = Make(-4, 0, contour);
  // Decentring by 5.3 mm tilts the front against the rim: over a reach of 30 mm on a curve of
  // 1/130 mm that is 5.3 / 130 * 30 = 1.2 mm, and the curves differ besides. A bevel at a fixed
  // share of the edge leaves that; one that follows the groove does not.
  CutOptions fixed;
  fixed.bevel_position = 0.5;
  const auto stiff = CutAndMount(lens, frame.left, centre, fixed);
  ASSERT_TRUE(stiff.has_value());
  EXPECT_GT(stiff->mount_misfit_mm, 0.1);
  EXPECT_LT(stiff->mount_misfit_mm, 2.0);
  const auto follows = CutAndMount(lens, frame.left, centre);
  ASSERT_TRUE(follows.has_value());
  EXPECT_LT(follows->mount_misfit_mm, stiff->mount_misfit_mm / 2);
  // Where the misfit says so, the apex is that far from the groove, and nowhere farther; it never
  // leaves the edge.
  const Eigen::Isometry3d opening_from_lens =
      frame.left.frame_from_opening.inverse() * follows->frame_from_lens;
  double worst = 0;
  const std::size_t n = follows->contour_mm.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector2d& p = follows->contour_mm[k];
    const double front = FrontHit(lens.lens(), p)->point.z();
    const double back = BackHit(lens.lens(), p)->point.z();
    EXPECT_GT(follows->apex_z_mm[k], front);
    EXPECT_LT(follows->apex_z_mm[k], back);
    const Eigen::Vector3d apex =
        opening_from_lens * Eigen::Vector3d(p.x(), p.y(), follows->apex_z_mm[k]);
    worst = std::max(worst, std::abs(apex.z() - frame.left.groove_height_mm[n - 1 - k]));
  }
  EXPECT_NEAR(worst, follows->mount_misfit_mm, 1e-9);
}

TEST(CutAndMount, SaysWhereAThinEdgeCannotFollowTheRim) {
  const FrameModel frame = *LoadFrame("aviator");
  const Eigen::Vector2d centre(-3.5, 4);
  const auto contour = ContourInLensFrame(frame.left.contour_mm, centre);
  const auto cut = CutAndMount(Make(5, 0, contour), frame.left, centre);
  ASSERT_TRUE(cut.has_value()) << cut.error().message;
  ASSERT_GT(cut->mount_misfit_mm, kMisfitNote_mm);
  ASSERT_EQ(cut->notes.size(), 1u);
  EXPECT_THAT(cut->notes[0], testing::HasSubstr("off the groove at"));
  EXPECT_THAT(cut->notes[0], testing::HasSubstr("more curved than the rim"));
}

TEST(CutAndMount, AGroovedEdgeIsAClosedMeshWithLessGlass) {
  const FrameModel frame = *LoadFrame("rectangle");
  const auto contour = ContourInLensFrame(frame.left.contour_mm, {0, 0});
  const CertifiedLens lens = Make(-2, 0, contour);
  CutOptions options;
  options.edge = EdgeForm::kFlat;
  const auto flat = CutAndMount(lens, frame.left, {0, 0}, options);
  options.edge = EdgeForm::kGroove;
  const auto grooved = CutAndMount(lens, frame.left, {0, 0}, options);
  ASSERT_TRUE(flat.has_value() && grooved.has_value());
  const MeshReport report = CheckMesh(grooved->mesh, true);
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(report.self_intersections, 0);
  // What is missing: the channel's section along the contour, shortened by half its depth all
  // around (2 pi * depth / 2), where the edge has room for all of it.
  const double channel = options.groove_width_mm * options.groove_depth_mm *
                         (frame.left.contour_mm.empty()
                              ? 0
                              : Perimeter(frame.left.contour_mm) - kPi * options.groove_depth_mm);
  const double less = CheckMesh(flat->mesh, false).volume_mm3 - report.volume_mm3;
  EXPECT_NEAR(less / channel, 1, 0.05);  // the mesh has chords for arcs
}

TEST(CutAndMount, SaysWhatIsTooSmallOrTooThin) {
  const LensOpening opening = RoundOpening(60);
  const CertifiedLens lens = Make(2, 0, ContourInLensFrame(RoundOpening(40).contour_mm, {0, 0}));
  const auto thin = CutAndMount(lens, opening, {0, 0});
  ASSERT_FALSE(thin.has_value());
  EXPECT_THAT(thin.error().message, testing::HasSubstr("thinner"));
  CutOptions options;
  options.blank_diameter_mm = 55;
  const auto small = CutAndMount(lens, opening, {0, 0}, options);
  ASSERT_FALSE(small.has_value());
  EXPECT_THAT(small.error().message, testing::HasSubstr("want 60.0 mm"));
}

TEST(EdgeThicknessByAngle, IsTheTallestWhereAMinusLensReachesFarthest) {
  const FrameModel frame = *LoadFrame("rectangle");
  const Eigen::Vector2d centre(0, 0);
  const auto contour = ContourInLensFrame(frame.left.contour_mm, centre);
  const auto cut = CutAndMount(Make(-5, 0, contour), frame.left, centre);
  ASSERT_TRUE(cut.has_value());
  const auto thickness = EdgeThicknessByAngle(*cut, frame.left, 360);
  EXPECT_GT(thickness[0], thickness[90]);  // wider than high
  EXPECT_NEAR(*std::max_element(thickness.begin(), thickness.end()),
              cut->lens.design().max_edge_thickness_mm, 0.02);
}

}  // namespace
}  // namespace lorgnette
