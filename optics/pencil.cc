// SPDX-License-Identifier: Apache-2.0
#include "optics/pencil.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "base/linear_algebra.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

constexpr double kRounding_mm = 1e-15;  // of a traced point or a unit direction's component

// Where rays of a pencil go in the plane across the leaving chief ray: height and slope.
struct Screen {
  Eigen::Vector3d origin, x, y, z;

  explicit Screen(const Ray& chief) : origin(chief.origin), z(chief.direction) {
    const Eigen::Quaterniond turn = ShortestTurn(Eigen::Vector3d::UnitZ(), chief.direction);
    x = turn * Eigen::Vector3d::UnitX();
    y = turn * Eigen::Vector3d::UnitY();
  }
  Eigen::Vector2d Slope(const Ray& ray) const {
    return Eigen::Vector2d(ray.direction.dot(x), ray.direction.dot(y)) / ray.direction.dot(z);
  }
  Eigen::Vector2d Height(const Ray& ray) const {
    const Eigen::Vector3d p = ray.origin - origin;
    return Eigen::Vector2d(p.dot(x), p.dot(y)) - p.dot(z) * Slope(ray);
  }
};

struct Extrapolated {
  Eigen::Matrix2d value;
  double error;
};

// Limit at h = 0 of an even function sampled at h, h/2, h/4.
Extrapolated ToZero(const std::array<Eigen::Matrix2d, 3>& at) {
  const Eigen::Matrix2d coarse = (4 * at[1] - at[0]) / 3, fine = (4 * at[2] - at[1]) / 3;
  const Eigen::Matrix2d limit = (16 * fine - coarse) / 15;
  return {limit, (limit - fine).cwiseAbs().maxCoeff()};
}

}  // namespace

namespace {

// Vergence of a parallel pencil around `chief` after `trace`, across the leaving chief ray. The
// columns of the result's basis are the lens frame's x, y turned with the ray.
using RayMap = std::function<std::optional<Ray>(const Ray&)>;
std::optional<PencilPower> VergenceOf(const RayMap& trace, const Ray& chief, double index_after) {
  const auto leaving = trace(chief);
  if (!leaving) return std::nullopt;
  const Screen before(chief), screen(*leaving);

  std::array<Eigen::Matrix2d, 3> vergence;
  double h = kPencilHeight_mm;
  for (Eigen::Matrix2d& v : vergence) {
    Eigen::Matrix2d height, slope;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector3d step = h * (k == 0 ? before.x : before.y);
      const auto plus = trace({chief.origin + step, chief.direction});
      const auto minus = trace({chief.origin - step, chief.direction});
      if (!plus || !minus) return std::nullopt;
      height.col(k) = screen.Height(*plus) - screen.Height(*minus);
      slope.col(k) = screen.Slope(*plus) - screen.Slope(*minus);
    }
    v = -1000 * index_after * slope * height.inverse();
    h /= 2;
  }
  const Extrapolated limit = ToZero(vergence);

  PencilPower result;
  result.power_D = limit.value;
  const double size = 1 + limit.value.cwiseAbs().maxCoeff();
  result.power_error_D = limit.error + 1000 * size * kRounding_mm / (kPencilHeight_mm / 4);
  result.prism = 100 * leaving->direction.head<2>() / leaving->direction.z();
  result.prism_error = 100 * 8 * kRounding_mm;
  return result;
}

}  // namespace

std::optional<PencilPower> MeasurePower(const Lens& lens, double index) {
  const RayMap through = [&](const Ray& ray) -> std::optional<Ray> {
    const LensTrace trace = TraceThrough(lens, ray, index);
    return trace.status == RayStatus::kOk ? std::optional(trace.exit) : std::nullopt;
  };
  return VergenceOf(through, {{0, 0, 0}, {0, 0, 1}}, 1);
}

std::optional<PencilPower> MeasureFrontPower(const Surface& front, const Eigen::Vector2d& at,
                                             double index) {
  const auto jet = front.Jet(at.x(), at.y());
  if (!jet) return std::nullopt;
  const RayMap into = [&](const Ray& ray) -> std::optional<Ray> {
    const auto hit = front.Intersect(ray);
    if (!hit) return std::nullopt;
    const auto inside = Refract(ray.direction, hit->normal, 1 / index);
    return inside ? std::optional(Ray{hit->point, inside->normalized()}) : std::nullopt;
  };
  const Ray chief{{at.x(), at.y(), jet->z}, Eigen::Vector3d(-jet->zx, -jet->zy, 1).normalized()};
  auto power = VergenceOf(into, chief, index);
  if (power) power->prism.setZero();
  return power;
}

std::optional<PencilMagnification> MeasureObserverMagnification(const Lens& lens, double index,
                                                                double camera_mm, double depth_mm) {
  const double plane_z = lens.center_thickness_mm + depth_mm;
  const double distance = camera_mm + plane_z;
  // Where the camera's ray of these slopes meets the feature's plane.
  const auto lands = [&](const Eigen::Vector2d& slope) -> std::optional<Eigen::Vector2d> {
    const Ray ray{{0, 0, -camera_mm}, Eigen::Vector3d(slope.x(), slope.y(), 1).normalized()};
    const LensTrace trace = TraceThrough(lens, ray, index);
    if (trace.status != RayStatus::kOk) return std::nullopt;
    const Ray& out = trace.exit;
    const double t = (plane_z - out.origin.z()) / out.direction.z();
    return Eigen::Vector2d((out.origin + t * out.direction).head<2>());
  };

  std::array<Eigen::Matrix2d, 3> magnification;
  double h = kPencilHeight_mm;
  for (Eigen::Matrix2d& m : magnification) {
    Eigen::Matrix2d height;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d slope = h / camera_mm * Eigen::Vector2d::Unit(k);
      const auto plus = lands(slope), minus = lands(-slope);
      if (!plus || !minus) return std::nullopt;
      height.col(k) = *plus - *minus;
    }
    m = distance * (2 * h / camera_mm) * height.inverse();
    h /= 2;
  }
  const Extrapolated limit = ToZero(magnification);
  const double rounding = distance * kRounding_mm / (kPencilHeight_mm / 4);
  return PencilMagnification{limit.value, limit.error + rounding};
}

}  // namespace lorgnette
