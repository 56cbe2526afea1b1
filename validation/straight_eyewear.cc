// SPDX-License-Identifier: Apache-2.0
#include "validation/straight_eyewear.h"

#include <cmath>

#include "base/units.h"
#include "optics/certify.h"

namespace lorgnette::validation {
namespace {

std::vector<Eigen::Vector2d> Ellipse(double width_mm, double height_mm) {
  constexpr int kPoints = 120;
  std::vector<Eigen::Vector2d> contour;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * kPi * i / kPoints;
    contour.emplace_back(0.5 * width_mm * std::cos(angle), 0.5 * height_mm * std::sin(angle));
  }
  return contour;
}

}  // namespace

Result<Eyewear> StraightEyewear(LensOrder order) {
  order.contour_mm = Ellipse(48, 36);
  const auto cut = [&](Eye eye, double x) -> Result<CutLens> {
    order.eye = eye;
    LG_ASSIGN(LensDesign design, DesignLens(order));
    LG_ASSIGN(CertifiedLens lens, Certify(std::move(design)));
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::Vector3d(-1, 1, -1).asDiagonal();
    pose.translation() =
        Eigen::Vector3d(x, 0, kStraightVertex_mm + lens.lens().center_thickness_mm);
    return CutLens{std::move(lens), order.contour_mm, pose, {}, 0};
  };
  LG_ASSIGN(CutLens right, cut(Eye::kRight, -kStraightHalfPd_mm));
  LG_ASSIGN(CutLens left, cut(Eye::kLeft, kStraightHalfPd_mm));
  Eyewear eyewear{FrameModel{}, std::move(right), std::move(left), Eigen::Isometry3d::Identity(),
                  WearingPosition{}};
  eyewear.frame.name = "none";
  return eyewear;
}

TriangleMesh FlatFace(double z_mm, int cells) {
  constexpr double kHalf_mm = 100;
  TriangleMesh mesh;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      mesh.positions.emplace_back(kHalf_mm * (2.0 * i / cells - 1),
                                  kHalf_mm * (2.0 * j / cells - 1), z_mm);
      mesh.normals.emplace_back(0, 0, 1);
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.emplace_back(a, b, d);
      mesh.triangles.emplace_back(a, d, c);
    }
  }
  return mesh;
}

StraightView ViewOnRightAxis(double camera_mm, int size_px, double focal_px) {
  StraightView view;
  view.camera = {size_px, size_px, focal_px, focal_px, 0.5 * size_px, 0.5 * size_px};
  view.camera_from_head.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  view.camera_from_head.translation() = Eigen::Vector3d(kStraightHalfPd_mm, 0, camera_mm);
  return view;
}

}  // namespace lorgnette::validation
