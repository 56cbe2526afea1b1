// SPDX-License-Identifier: Apache-2.0
// Magnification through the whole picture: a dot grid in the plane of the iris, rendered by the
// compositor that makes the video, its dots found again in the output.
#include <gtest/gtest.h>

#include <cmath>

#include "optics/magnification.h"
#include "optics/trace.h"
#include "tests/render/render_test_scene.h"

namespace lorgnette {
namespace {

using test::LensRecipe;

constexpr double kCameraDistance_mm = 600;  // from the plane of the corneal apices
constexpr double kFocal_px = 5400;          // 9 px a mm at the iris: a close-up
constexpr double kIrisDepth_mm = 3.05;      // behind the corneal apex
constexpr double kSpacing_mm = 2.0;
constexpr int kReach = 6;               // dots on each side of the axis: to 12 mm
constexpr double kDotRadius_mm = 0.28;  // standard deviation of a dot's Gaussian

// The bounds.
constexpr double kSpacingTolerance = 1e-3;  // of the paraxial prediction, on the axis
constexpr double kDotTolerance_px = 0.02;   // of the exact ray, at every dot

double DotLight(double x_mm, double y_mm) {
  const auto wrapped = [](double v) { return v - kSpacing_mm * std::round(v / kSpacing_mm); };
  const double r2 = std::pow(wrapped(x_mm), 2) + std::pow(wrapped(y_mm), 2);
  return std::exp(-r2 / (2 * kDotRadius_mm * kDotRadius_mm));
}

// The grid as the camera sees it without glasses: box means of 6 x 6 points a pixel.
ImageRgbF DrawGrid(const test::View& view, double depth_mm) {
  ImageRgbF image(view.camera.width, view.camera.height);
  constexpr int kSub = 6;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      double sum = 0;
      for (int s = 0; s < kSub * kSub; ++s) {
        const Eigen::Vector3d d =
            view.camera.Direction(x + (s % kSub + 0.5) / kSub, y + (s / kSub + 0.5) / kSub);
        sum += DotLight(depth_mm * d.x(), depth_mm * d.y());
      }
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(sum / (kSub * kSub));
    }
  }
  return image;
}

// Centre of light near a first guess, by repeated means under a Gaussian window.
Eigen::Vector2d FindDot(const ImageRgbF& image, Eigen::Vector2d centre, double radius_px) {
  const int reach = int(std::ceil(3.2 * radius_px));
  for (int round = 0; round < 60; ++round) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double weight = 0;
    const int x0 = int(centre.x()), y0 = int(centre.y());
    for (int y = y0 - reach; y <= y0 + reach; ++y) {
      for (int x = x0 - reach; x <= x0 + reach; ++x) {
        if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
        const Eigen::Vector2d p(x + 0.5, y + 0.5);
        const double w = std::exp(-(p - centre).squaredNorm() / (2 * radius_px * radius_px)) *
                         double(image.at(x, y)[1]);
        sum += w * p;
        weight += w;
      }
    }
    const Eigen::Vector2d next = sum / weight;
    // The window pulls the mean half of the way back: twice the step is Newton's.
    const Eigen::Vector2d step = 2 * (next - centre);
    centre += step;
    if (step.norm() < 1e-6) break;
  }
  return centre;
}

class DotGrid : public testing::TestWithParam<LensRecipe> {};

TEST_P(DotGrid, AppearsAtTheSizeThatTheOpticsPredict) {
  const LensRecipe recipe = GetParam();
  const Eyewear eyewear = test::MakeEyewear(recipe);
  const Lens& lens = eyewear.right.lens.lens();
  const test::View view =
      test::ViewFrom(-test::kHalfPd_mm, 0, kCameraDistance_mm, 300, 300, kFocal_px);
  const TriangleMesh face = test::Wall(200, -kIrisDepth_mm);
  const double plane_depth_mm = kCameraDistance_mm + kIrisDepth_mm;
  const ImageRgbF input = DrawGrid(view, plane_depth_mm);

  auto compositor =
      Compositor::Create(eyewear, face, TriangleMesh{},
                         Environment::Constant(Eigen::Vector3f::Zero()), CompositorOptions{});
  ASSERT_TRUE(compositor) << compositor.error().message;
  const ImageRgbF output = compositor->Render(input, view.camera, view.camera_from_head);

  const double thickness = lens.center_thickness_mm;
  const ObserverGeometry geometry{kCameraDistance_mm - test::kVertexDistance_mm - thickness,
                                  test::kVertexDistance_mm + kIrisDepth_mm};
  const double index = lens.medium.index_d;
  const auto expected = [&](const Eigen::Vector2d& head_mm) {
    // The lens frame's x runs against the head's; the camera's y runs down.
    const auto ray = ObserverExact(lens, index, geometry, {-head_mm.x(), head_mm.y()});
    EXPECT_TRUE(ray.has_value());
    return Eigen::Vector2d(view.camera.cx - view.camera.fx * ray->camera_tangent.x(),
                           view.camera.cy - view.camera.fy * ray->camera_tangent.y());
  };

  double worst_px = 0;
  const double radius_px = kDotRadius_mm * kFocal_px / plane_depth_mm;
  for (int j = -kReach; j <= kReach; ++j) {
    for (int i = -kReach; i <= kReach; ++i) {
      const Eigen::Vector2d at = kSpacing_mm * Eigen::Vector2d(i, j);
      const Eigen::Vector2d prediction =
          i == 0 && j == 0 ? Eigen::Vector2d(view.camera.cx, view.camera.cy) : expected(at);
      const Eigen::Vector2d found = FindDot(output, prediction, radius_px);
      worst_px = std::max(worst_px, (found - prediction).norm());
      EXPECT_LT((found - prediction).norm(), kDotTolerance_px) << "dot " << i << ", " << j;
    }
  }
  RecordProperty("worst_px", std::to_string(worst_px));

  // Spacing of the dots next to the axis against the thick lens to first order.
  const double predicted = ObserverMagnification(lens, index, geometry)(0, 0);
  const double bare_px = kSpacing_mm * kFocal_px / plane_depth_mm;
  const Eigen::Vector2d left = FindDot(output, expected({-kSpacing_mm, 0}), radius_px);
  const Eigen::Vector2d right = FindDot(output, expected({kSpacing_mm, 0}), radius_px);
  const double measured = (right.x() - left.x()) / (2 * bare_px);
  EXPECT_NEAR(measured / predicted, 1, kSpacingTolerance);
  if (recipe.sphere < 0) {
    EXPECT_LT(measured, 0.95);
  }
  if (recipe.sphere > 0) {
    EXPECT_GT(measured, 1.05);
  }
}

INSTANTIATE_TEST_SUITE_P(Powers, DotGrid,
                         testing::Values(LensRecipe{-6, 0, 0, 1.6}, LensRecipe{5, 0, 0, 1.5},
                                         LensRecipe{0, 0, 0, 1.5}),
                         [](const auto& parameter) {
                           const double s = parameter.param.sphere;
                           return s < 0 ? "Minus6" : s > 0 ? "Plus5" : "Plano";
                         });

}  // namespace
}  // namespace lorgnette
