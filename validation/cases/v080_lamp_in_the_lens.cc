// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>
#include <cmath>
#include <optional>

#include "base/units.h"
#include "optics/trace.h"
#include "render/compositor.h"
#include "validation/case.h"
#include "validation/straight_eyewear.h"

namespace lorgnette::validation {
namespace {

constexpr double kCamera_mm = 400, kFocal_px = 2700;
constexpr int kSize_px = 400;
constexpr float kLamp = 10;

// A round lamp in the dark, about `at` (world axes, unit).
Environment Lamp(const Eigen::Vector3d& at) {
  constexpr int kWidth = 1024, kHeight = 512;
  constexpr double kRadius_rad = 0.02;
  ImageRgbF map(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    const double lat = kPi * (0.5 - (y + 0.5) / kHeight);
    for (int x = 0; x < kWidth; ++x) {
      const double lon = 2 * kPi * ((x + 0.5) / kWidth - 0.5);
      // The rule of render/environment.h, written out again.
      const Eigen::Vector3d d(-std::sin(lon) * std::cos(lat), std::sin(lat),
                              std::cos(lon) * std::cos(lat));
      if (d.dot(at) < std::cos(kRadius_rad)) continue;
      for (int c = 0; c < 3; ++c) map.at(x, y)[c] = kLamp;
    }
  }
  return Environment(std::move(map));
}

// Where a camera ray goes that the front surface mirrors, or, through it, the back surface, and the
// share of the light that takes this way. Lens frame.
struct Mirrored {
  Eigen::Vector3d direction;
  double share;
};
std::optional<Mirrored> Mirror(const Lens& lens, const Ray& ray, bool at_back) {
  const double n = lens.medium.index_d;
  const auto front = lens.front.Intersect(ray);
  if (!front) return std::nullopt;
  const double r1 = FresnelReflectance(std::abs(ray.direction.dot(front->normal)), 1 / n);
  if (!at_back) return Mirrored{Reflect(ray.direction, front->normal), r1};
  const auto in = Refract(ray.direction, front->normal, 1 / n);
  const auto back = in ? IntersectBack(lens, {front->point, *in}) : std::nullopt;
  if (!back) return std::nullopt;
  const double r2 = FresnelReflectance(std::abs(in->dot(back->normal)), n);
  const Eigen::Vector3d returning = Reflect(*in, back->normal);
  const auto out = lens.front.Intersect({back->point, returning});
  if (!out) return std::nullopt;
  const double r3 = FresnelReflectance(std::abs(returning.dot(out->normal)), n);
  const auto leaves = Refract(returning, out->normal, n);
  if (!leaves) return std::nullopt;
  return Mirrored{*leaves, (1 - r1) * r2 * (1 - r3)};
}

void RunV080(CaseRun& run) {
  LensOrder order;
  order.rx.sphere = Diopters(-6);
  order.medium.index_d = 1.6;
  const auto eyewear = StraightEyewear(order);
  if (!eyewear) return;
  const Lens& lens = eyewear->right.lens.lens();
  const StraightView view = ViewOnRightAxis(kCamera_mm, kSize_px, kFocal_px);
  // Up and to the wearer's left; world axes are the head's here.
  const Eigen::Vector3d lamp = Eigen::Vector3d(0.16, 0.1, 1).normalized();
  const auto compositor =
      Compositor::Create(*eyewear, FlatFace(-3), TriangleMesh{}, Lamp(lamp), CompositorOptions{});
  if (!compositor) return;
  const ImageRgbF picture =
      compositor->Render(ImageRgbF(kSize_px, kSize_px), view.camera, view.camera_from_head);

  for (const bool at_back : {false, true}) {
    const std::string name = at_back ? "back surface: " : "front surface: ";
    const auto mirrored = [&](const Eigen::Vector2d& px) -> std::optional<Mirrored> {
      const Eigen::Vector3d d = view.camera.Direction(px.x(), px.y()).normalized();
      const Eigen::Vector3d head(d.x(), -d.y(), -d.z());
      const Ray ray{{0, 0, kStraightVertex_mm + lens.center_thickness_mm - kCamera_mm},
                    LensFromHeadDirection(head)};
      auto found = Mirror(lens, ray, at_back);
      if (found) found->direction = LensFromHeadDirection(found->direction);  // its own inverse
      return found;
    };
    // The pixel whose ray is mirrored into the lamp's middle, by Newton's steps.
    Eigen::Vector2d px(0.5 * kSize_px, 0.5 * kSize_px);
    for (int i = 0; i < 8; ++i) {
      const auto miss = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
        const auto m = mirrored(p);
        if (!m) return Eigen::Vector2d(1, 1);
        return Eigen::Vector2d(m->direction.x() / m->direction.z() - lamp.x() / lamp.z(),
                               m->direction.y() / m->direction.z() - lamp.y() / lamp.z());
      };
      Eigen::Matrix2d slope;
      slope.col(0) = (miss(px + Eigen::Vector2d(0.01, 0)) - miss(px)) / 0.01;
      slope.col(1) = (miss(px + Eigen::Vector2d(0, 0.01)) - miss(px)) / 0.01;
      px -= slope.inverse() * miss(px);
    }
    const auto there = mirrored(px);
    const int x = int(px.x()), y = int(px.y());
    if (!there || x < 8 || y < 8 || x >= kSize_px - 8 || y >= kSize_px - 8) {
      run.Bound(name + "the lamp is in the picture", "1", 1, 0, "the scene is made so");
      continue;
    }
    run.Within(name + "light at the predicted pixel over lamp times reflectance", "1", 1,
               double(picture.at(x, y)[1]) / (kLamp * there->share), 0.01, "the lamp is flat");
    // The centre of the blob: mean over pixels of more than half that light, from the prediction
    // on.
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double count = 0;
    const int reach = at_back ? 12 : 40;
    for (int v = y - reach; v <= y + reach; ++v) {
      for (int u = x - reach; u <= x + reach; ++u) {
        if (u < 0 || v < 0 || u >= kSize_px || v >= kSize_px) continue;
        const double light = double(picture.at(u, v)[1]) / (kLamp * there->share);
        if (light < 0.5 || light > 1.5) continue;
        sum += Eigen::Vector2d(u + 0.5, v + 0.5);
        ++count;
      }
    }
    run.Within(name + "distance of the lamp's image from its exact ray", "px", 0,
               count > 0 ? (sum / count - px).norm() : 1e9, 1,
               "whole pixels counted; texels of a third of a degree");
  }
}

}  // namespace

extern const Case kV080;
const Case kV080 = {"V080", "image",
                    "a lamp mirrored by the front and by the back surface of a -6 D lens",
                    "exact rays and Fresnel's formulas against the compositor's picture", RunV080};

}  // namespace lorgnette::validation
