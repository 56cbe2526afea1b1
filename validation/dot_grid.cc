// SPDX-License-Identifier: Apache-2.0
#include "validation/dot_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "optics/magnification.h"
#include "render/compositor.h"
#include "validation/straight_eyewear.h"

namespace lorgnette::validation {
namespace {

constexpr double kIrisDepth_mm = 3.05;

// The grid as the camera sees it without glasses: box means of 6 x 6 points a pixel.
ImageRgbF DrawGrid(const Camera& camera, double depth_mm, const DotGridOptions& options) {
  constexpr int kSub = 6;
  const auto wrapped = [&](double v) {
    return v - options.spacing_mm * std::round(v / options.spacing_mm);
  };
  ImageRgbF image(camera.width, camera.height);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      double sum = 0;
      for (int s = 0; s < kSub * kSub; ++s) {
        const int column = s % kSub, row = s / kSub;
        const Eigen::Vector3d d =
            depth_mm * camera.Direction(x + (column + 0.5) / kSub, y + (row + 0.5) / kSub);
        const double r2 = std::pow(wrapped(d.x()), 2) + std::pow(wrapped(d.y()), 2);
        sum += std::exp(-r2 / (2 * options.dot_mm * options.dot_mm));
      }
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(sum / (kSub * kSub));
    }
  }
  return image;
}

// Centre of light near a first guess, by repeated means under a Gaussian window.
Eigen::Vector2d Refine(const ImageRgbF& image, Eigen::Vector2d centre, double radius_px) {
  const int reach = int(std::ceil(3.2 * radius_px));
  for (int round = 0; round < 60; ++round) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double weight = 0;
    const int x0 = int(centre.x()), y0 = int(centre.y());
    for (int y = std::max(0, y0 - reach); y <= std::min(image.height - 1, y0 + reach); ++y) {
      for (int x = std::max(0, x0 - reach); x <= std::min(image.width - 1, x0 + reach); ++x) {
        const Eigen::Vector2d p(x + 0.5, y + 0.5);
        const double w = std::exp(-(p - centre).squaredNorm() / (2 * radius_px * radius_px)) *
                         double(image.at(x, y)[1]);
        sum += w * p;
        weight += w;
      }
    }
    if (!(weight > 0)) return centre;
    // The window pulls the mean half of the way back: twice the step is Newton's.
    const Eigen::Vector2d step = 2 * (sum / weight - centre);
    centre += step;
    if (step.norm() < 1e-6) break;
  }
  return centre;
}

}  // namespace

std::vector<Eigen::Vector2d> DetectDots(const ImageRgbF& image, double radius_px) {
  float brightest = 0;
  for (std::size_t i = 1; i < image.data.size(); i += 3) {
    brightest = std::max(brightest, image.data[i]);
  }
  std::vector<Eigen::Vector2d> dots;
  for (int y = 2; y < image.height - 2; ++y) {
    for (int x = 2; x < image.width - 2; ++x) {
      const float here = image.at(x, y)[1];
      if (here < brightest / 3) continue;
      bool greatest = true;
      for (int dy = -2; dy <= 2 && greatest; ++dy) {
        for (int dx = -2; dx <= 2 && greatest; ++dx) {
          greatest = image.at(x + dx, y + dy)[1] <= here;
        }
      }
      if (!greatest) continue;
      const Eigen::Vector2d dot = Refine(image, {x + 0.5, y + 0.5}, radius_px);
      // Neighbours of equal light refine to one dot.
      const bool known = std::any_of(dots.begin(), dots.end(), [&](const Eigen::Vector2d& other) {
        return (other - dot).norm() < 0.5;
      });
      if (!known) dots.push_back(dot);
    }
  }
  return dots;
}

Result<DotGridResult> MeasureDotGrid(const LensOrder& order, const DotGridOptions& options) {
  LG_ASSIGN(const Eyewear eyewear, StraightEyewear(order));
  const Lens& lens = eyewear.right.lens.lens();
  const StraightView view = ViewOnRightAxis(options.camera_mm, options.size_px, options.focal_px);
  const Camera& camera = view.camera;
  const double plane_mm = options.camera_mm + kIrisDepth_mm;
  const ImageRgbF input = DrawGrid(camera, plane_mm, options);
  LG_ASSIGN(
      const Compositor compositor,
      Compositor::Create(eyewear, FlatFace(-kIrisDepth_mm), TriangleMesh{},
                         Environment::Constant(Eigen::Vector3f::Zero()), CompositorOptions{}));
  const ImageRgbF output = compositor.Render(input, camera, view.camera_from_head);

  const double thickness = lens.center_thickness_mm, index = lens.medium.index_d;
  const ObserverGeometry geometry{options.camera_mm - kStraightVertex_mm - thickness,
                                  kStraightVertex_mm + kIrisDepth_mm};
  // The lens frame's x runs against the head's; the camera's y runs down.
  const auto expected = [&](const Eigen::Vector2d& head_mm) -> Result<Eigen::Vector2d> {
    Eigen::Vector2d tangent = Eigen::Vector2d::Zero();
    // On the axis two features beside it, since a ray is found by its feature's height.
    const bool on_axis = head_mm.norm() < kObserverMinHeight_mm;
    for (const double side : {1.0, -1.0}) {
      const Eigen::Vector2d feature = on_axis ? Eigen::Vector2d(side * kObserverMinHeight_mm, 0)
                                              : Eigen::Vector2d(-head_mm.x(), head_mm.y());
      const auto ray = ObserverExact(lens, index, geometry, feature);
      if (!ray) return Failure("dot grid: no ray reaches a dot of this lens");
      tangent += 0.5 * ray->camera_tangent;
    }
    return Eigen::Vector2d(camera.cx - camera.fx * tangent.x(),
                           camera.cy - camera.fy * tangent.y());
  };

  const double radius_px = options.dot_mm * options.focal_px / plane_mm;
  const double bare_px = options.spacing_mm * options.focal_px / plane_mm;
  const std::vector<Eigen::Vector2d> dots = DetectDots(output, radius_px);
  DotGridResult result;
  double sum = 0;
  Eigen::Vector2d beside[2][2];  // the dots next to the axis: along x and y, before and after
  for (int j = -options.reach; j <= options.reach; ++j) {
    for (int i = -options.reach; i <= options.reach; ++i) {
      LG_ASSIGN(const Eigen::Vector2d prediction,
                expected(options.spacing_mm * Eigen::Vector2d(i, j)));
      ++result.dots;
      Eigen::Vector2d nearest = Eigen::Vector2d::Zero();
      int near = 0;
      for (const Eigen::Vector2d& dot : dots) {
        if ((dot - prediction).norm() > bare_px / 4) continue;
        ++near;
        nearest = dot;
      }
      if (near != 1) continue;
      ++result.found;
      const double error = (nearest - prediction).norm();
      sum += error;
      if (error >= result.worst_px) {
        result.worst_px = error;
        result.worst_at = fmt::format("dot ({}, {})", i, j);
      }
      if (j == 0 && std::abs(i) == 1) beside[0][i > 0] = nearest;
      if (i == 0 && std::abs(j) == 1) beside[1][j > 0] = nearest;
    }
  }
  result.mean_px = result.found > 0 ? sum / result.found : 0;
  const Eigen::Matrix2d first_order = ObserverMagnification(lens, index, geometry);
  for (int k = 0; k < 2; ++k) {
    const double step = std::abs(beside[k][1][k] - beside[k][0][k]) / (2 * bare_px);
    result.magnification[k] = step;
    result.spacing_error = std::max(result.spacing_error, std::abs(step / first_order(k, k) - 1));
  }
  return result;
}

void CheckDotGrid(CaseRun& run, const LensOrder& order, bool spacing) {
  const auto result = MeasureDotGrid(order);
  if (!result) {
    run.Bound(result.error().message, "1", 1, 0, "the picture can be made");
    return;
  }
  run.Exact("dots found in the picture", "1", result->dots, result->found, 12);
  run.Bound("farthest from its exact ray, " + result->worst_at, "px", result->worst_px,
            kDotTolerance_px, "a fiftieth of a pixel, asked of every dot");
  run.Bound("mean distance from the exact rays", "px", result->mean_px, kDotTolerance_px / 2,
            "half of what is asked of every dot");
  if (spacing) {
    run.Bound("spacing on the axis against the thick lens, relative", "1", result->spacing_error,
              kSpacingTolerance, "asked; distortion over 2 mm is a tenth of it");
  }
}

}  // namespace lorgnette::validation
