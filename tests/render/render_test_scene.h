// SPDX-License-Identifier: Apache-2.0
// A wearer made for tests: a flat or spherical face, two certified lenses on straight axes, and a
// frame of choice; the camera looks along -z of the head.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <utility>
#include <vector>

#include "base/units.h"
#include "geometry/eyewear.h"
#include "optics/certify.h"
#include "optics/design.h"
#include "render/compositor.h"

namespace lorgnette::test {

inline std::vector<Eigen::Vector2d> Ellipse(double a_mm, double b_mm, int points = 120) {
  std::vector<Eigen::Vector2d> contour;
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * kPi * i / points;
    contour.emplace_back(0.5 * a_mm * std::cos(angle), 0.5 * b_mm * std::sin(angle));
  }
  return contour;
}

struct LensRecipe {
  double sphere = -6, cylinder = 0, axis = 0, index = 1.6;
  double width_mm = 48, height_mm = 36;
  double abbe = 58;
};

inline CertifiedLens MakeLens(const LensRecipe& recipe, Eye eye = Eye::kRight) {
  LensOrder order;
  order.eye = eye;
  order.rx.sphere = Diopters(recipe.sphere);
  order.rx.cylinder = Diopters(recipe.cylinder);
  order.rx.axis = AxisDegrees(recipe.axis);
  order.medium.index_d = recipe.index;
  order.medium.abbe = recipe.abbe;
  order.contour_mm = Ellipse(recipe.width_mm, recipe.height_mm);
  auto design = DesignLens(order);
  EXPECT_TRUE(design) << design.error().message;
  auto certified = Certify(*std::move(design));
  EXPECT_TRUE(certified) << certified.error().message;
  return *std::move(certified);
}

inline constexpr double kVertexDistance_mm = 14;
inline constexpr double kHalfPd_mm = 32;

// Back vertex at (-+32, 0, 14) of the head, axis along the head's z.
inline Eyewear MakeEyewear(const LensRecipe& recipe) {
  const auto cut = [&](Eye eye, double x) {
    CertifiedLens lens = MakeLens(recipe, eye);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::Vector3d(-1, 1, -1).asDiagonal();
    pose.translation() =
        Eigen::Vector3d(x, 0, kVertexDistance_mm + lens.lens().center_thickness_mm);
    return CutLens{std::move(lens), Ellipse(recipe.width_mm, recipe.height_mm), pose, {}, 0};
  };
  Eyewear eyewear{FrameModel{}, cut(Eye::kRight, -kHalfPd_mm), cut(Eye::kLeft, kHalfPd_mm),
                  Eigen::Isometry3d::Identity(), WearingPosition{}};
  eyewear.frame.name = "none";
  return eyewear;
}

// A thin round rim about each lens, as a tube of square section.
inline TriangleMesh Rim(double a_mm, double b_mm, const Eigen::Vector3d& centre) {
  TriangleMesh mesh;
  constexpr int kSides = 96;
  const double offsets[4][2] = {{-0.6, -2.5}, {2.4, -2.5}, {2.4, 2.5}, {-0.6, 2.5}};
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * kPi * i / kSides;
    const Eigen::Vector2d p(0.5 * a_mm * std::cos(angle), 0.5 * b_mm * std::sin(angle));
    const Eigen::Vector2d n =
        Eigen::Vector2d(std::cos(angle) / a_mm, std::sin(angle) / b_mm).normalized();
    for (const auto& o : offsets) {
      mesh.positions.push_back(centre +
                               Eigen::Vector3d(p.x() + o[0] * n.x(), p.y() + o[0] * n.y(), o[1]));
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

inline Eyewear WithRims(const LensRecipe& recipe) {
  Eyewear eyewear = MakeEyewear(recipe);
  FramePart part;
  part.name = "front";
  part.kind = FramePartKind::kFront;
  for (const double x : {-kHalfPd_mm, kHalfPd_mm}) {
    Append(part.mesh, Rim(recipe.width_mm, recipe.height_mm, {x, 0, kVertexDistance_mm + 1}));
  }
  part.material.diffuse = {0.3f, 0.1f, 0.05f};
  eyewear.frame.parts.push_back(std::move(part));
  return eyewear;
}

// A square facing +z, `side_mm` wide, at depth z, of 2 * cells^2 triangles.
inline TriangleMesh Wall(double side_mm, double z_mm, int cells = 8, double x_mm = 0,
                         double y_mm = 0) {
  TriangleMesh mesh;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      mesh.positions.emplace_back(x_mm + side_mm * (double(i) / cells - 0.5),
                                  y_mm + side_mm * (double(j) / cells - 0.5), z_mm);
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

// Camera at (x, y, distance) of the head, looking along -z, the picture's centre on that axis.
struct View {
  Camera camera;
  Eigen::Isometry3d camera_from_head = Eigen::Isometry3d::Identity();
};
inline View ViewFrom(double x_mm, double y_mm, double distance_mm, int width, int height,
                     double focal_px) {
  View view;
  view.camera = {width, height, focal_px, focal_px, 0.5 * width, 0.5 * height};
  view.camera_from_head.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  view.camera_from_head.translation() = Eigen::Vector3d(-x_mm, y_mm, distance_mm);
  return view;
}

inline ImageRgbF ConstantImage(int width, int height, float value) {
  ImageRgbF image(width, height);
  std::fill(image.data.begin(), image.data.end(), value);
  return image;
}

}  // namespace lorgnette::test
