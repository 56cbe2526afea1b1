// SPDX-License-Identifier: Apache-2.0
#include "optics/magnification.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "optics/trace.h"

namespace lorgnette {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Feature height over camera angle, m: J = L A + B + z (D + L C), with C = -Fe.
double ObserverJ_m(const ParaxialSystem& s, double camera_m, double depth_m) {
  return camera_m * s.a + s.b_m + depth_m * (s.d + camera_m * s.c_D);
}

Matrix2d ObserverJ_m(const AstigmaticSystem& s, double camera_m, double depth_m) {
  return camera_m * s.a + s.b_m + depth_m * (s.d + camera_m * s.c_D);
}

// Where a camera ray of tangent (u, v) meets the feature plane, and where it crossed the front.
struct PlaneHit {
  Vector2d plane_mm, front_mm;
};
std::optional<PlaneHit> CameraRay(const Lens& lens, double index, const ObserverGeometry& geometry,
                                  const Vector2d& tangent) {
  const Ray ray{{0, 0, -geometry.camera_mm}, Vector3d(tangent.x(), tangent.y(), 1).normalized()};
  const LensTrace trace = TraceThrough(lens, ray, index);
  if (trace.status != RayStatus::kOk || !(trace.exit.direction.z() > 0)) return std::nullopt;
  const double plane_z = lens.center_thickness_mm + geometry.depth_mm;
  const double steps = (plane_z - trace.exit.origin.z()) / trace.exit.direction.z();
  return PlaneHit{(trace.exit.origin + steps * trace.exit.direction).head<2>(),
                  trace.first.point.head<2>()};
}

}  // namespace

double ShapeFactor(Diopters front, double thickness_mm, double index) {
  return 1 / (1 - thickness_mm / 1000 / index * front.value());
}

double PowerFactor(Diopters back_vertex_power, double pupil_mm) {
  return 1 / (1 - pupil_mm / 1000 * back_vertex_power.value());
}

double SpectacleMagnification(const ParaxialSystem& system, double pupil_mm) {
  return 1 / (system.a + pupil_mm / 1000 * system.c_D);
}

Matrix2d SpectacleMagnification(const AstigmaticSystem& system, double pupil_mm) {
  const Matrix2d fv = system.BackVertexPower();
  return (Matrix2d::Identity() - pupil_mm / 1000 * fv).inverse() * system.a.inverse();
}

double SpectacleMagnificationNear(const ParaxialSystem& system, double thickness_mm,
                                  double pupil_mm, double object_mm) {
  return (object_mm + thickness_mm + pupil_mm) / 1000 /
         ObserverJ_m(system, object_mm / 1000, pupil_mm / 1000);
}

double ObserverMagnificationThin(Diopters power, const ObserverGeometry& geometry) {
  const double effective_m =
      geometry.depth_mm / 1000 * geometry.camera_mm / (geometry.camera_mm + geometry.depth_mm);
  return 1 / (1 - effective_m * power.value());
}

ObserverView ObserverParaxial(const ParaxialSystem& system, double thickness_mm,
                              const ObserverGeometry& geometry) {
  const double camera_m = geometry.camera_mm / 1000, depth_m = geometry.depth_mm / 1000;
  const double j_m = ObserverJ_m(system, camera_m, depth_m);
  const double inverse_lateral = system.a + depth_m * system.c_D;
  ObserverView view;
  view.magnification = (camera_m + thickness_mm / 1000 + depth_m) / j_m;
  view.lateral = 1 / inverse_lateral;
  view.apparent_depth_mm = 1000 * (system.d * depth_m + system.b_m) / inverse_lateral;
  view.camera_height_ratio = camera_m / j_m;
  return view;
}

Matrix2d ObserverMagnification(const AstigmaticSystem& system, double thickness_mm,
                               const ObserverGeometry& geometry) {
  const double camera_m = geometry.camera_mm / 1000, depth_m = geometry.depth_mm / 1000;
  return (camera_m + thickness_mm / 1000 + depth_m) *
         ObserverJ_m(system, camera_m, depth_m).inverse();
}

Matrix2d ObserverMagnification(const Lens& lens, double index, const ObserverGeometry& geometry) {
  return ObserverMagnification(SystemOf(lens, index), lens.center_thickness_mm, geometry);
}

std::optional<ObserverRay> ObserverExact(const Lens& lens, double index,
                                         const ObserverGeometry& geometry,
                                         const Vector2d& feature_mm) {
  constexpr int kMaxSteps = 50;
  // Rounding of the traced plane point, relative to the camera's distance.
  constexpr double kConverged = 16 * std::numeric_limits<double>::epsilon();

  Vector2d feature = feature_mm;
  if (feature.norm() < kObserverMinHeight_mm) {
    feature =
        kObserverMinHeight_mm * (feature.norm() > 0 ? feature.normalized() : Vector2d(1, 0)).eval();
  }
  const double bare_distance = geometry.camera_mm + lens.center_thickness_mm + geometry.depth_mm;
  const Vector2d bare = feature / bare_distance;

  // Newton with the paraxial inverse, then Broyden's updates: the map is smooth and close to it.
  Matrix2d inverse_j = ObserverMagnification(lens, index, geometry) / bare_distance;
  if (!inverse_j.allFinite()) return std::nullopt;
  Vector2d tangent = inverse_j * feature;
  std::optional<PlaneHit> hit = CameraRay(lens, index, geometry, tangent);
  // Past the domain of the surfaces the paraxial guess can miss: come back toward the axis.
  for (int i = 0; !hit && i < kMaxSteps; ++i) {
    tangent *= 0.9;
    hit = CameraRay(lens, index, geometry, tangent);
  }
  if (!hit) return std::nullopt;
  Vector2d residual = hit->plane_mm - feature;
  for (int i = 0; i < kMaxSteps && residual.norm() > kConverged * bare_distance; ++i) {
    Vector2d step = -inverse_j * residual;
    std::optional<PlaneHit> next = CameraRay(lens, index, geometry, tangent + step);
    for (int k = 0; !next && k < kMaxSteps; ++k) {
      step *= 0.5;
      next = CameraRay(lens, index, geometry, tangent + step);
    }
    if (!next) return std::nullopt;
    const Vector2d next_residual = next->plane_mm - feature;
    const Vector2d change = next_residual - residual;
    const Vector2d predicted = inverse_j * change;
    const double denominator = step.dot(predicted);
    if (denominator != 0) {
      inverse_j += (step - predicted) * (step.transpose() * inverse_j) / denominator;
    }
    // Rounding alone is left when a step no longer helps.
    if (next_residual.norm() >= residual.norm() && residual.norm() < 1e-9 * bare_distance) break;
    tangent += step;
    residual = next_residual;
    hit = next;
  }
  // A ray that comes no nearer than this does not reach the feature.
  if (residual.norm() > 1e-9 * bare_distance) return std::nullopt;
  ObserverRay ray;
  ray.camera_tangent = tangent;
  ray.front_mm = hit->front_mm;
  ray.magnification = tangent.dot(feature) / bare.dot(feature);
  return ray;
}

}  // namespace lorgnette
