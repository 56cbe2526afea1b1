// SPDX-License-Identifier: Apache-2.0
#include "optics/trace.h"

#include <algorithm>
#include <cmath>

namespace lorgnette {
namespace {

// 1 - eta^2 sin^2 i, written so that eta = 1 gives cos^2 i exactly.
double SquaredCosineAfter(double cosine, double eta) {
  return eta * eta * cosine * cosine + (1.0 - eta) * (1.0 + eta);
}

}  // namespace

std::optional<Eigen::Vector3d> Refract(const Eigen::Vector3d& incident,
                                       const Eigen::Vector3d& normal, double eta) {
  const double c = incident.dot(normal);
  const double after2 = SquaredCosineAfter(c, eta);
  if (!(after2 >= 0)) return std::nullopt;
  const double along = std::copysign(std::sqrt(after2), c) - eta * c;
  return eta * incident + along * normal;
}

Eigen::Vector3d Reflect(const Eigen::Vector3d& incident, const Eigen::Vector3d& normal) {
  return incident - 2.0 * incident.dot(normal) * normal;
}

double FresnelReflectance(double cos_incident, double eta) {
  const double c = std::clamp(std::abs(cos_incident), 0.0, 1.0);
  if (eta == 1.0) return 0;
  const double after2 = SquaredCosineAfter(c, eta);
  if (after2 <= 0) return 1;
  const double after = std::sqrt(after2);
  const double rs = (eta * c - after) / (eta * c + after);
  const double rp = (c - eta * after) / (c + eta * after);
  return 0.5 * (rs * rs + rp * rp);
}

Eigen::Matrix3d BackRotation(const Lens& lens) {
  const double cx = std::cos(lens.back_tilt_x), sx = std::sin(lens.back_tilt_x);
  const double cy = std::cos(lens.back_tilt_y), sy = std::sin(lens.back_tilt_y);
  Eigen::Matrix3d about_x, about_y;
  about_x << 1, 0, 0, 0, cx, -sx, 0, sx, cx;
  about_y << cy, 0, sy, 0, 1, 0, -sy, 0, cy;
  return about_y * about_x;
}

std::optional<SurfaceHit> IntersectBack(const Lens& lens, const Ray& ray) {
  const Eigen::Vector3d vertex(0, 0, lens.center_thickness_mm);
  if (lens.back_tilt_x == 0 && lens.back_tilt_y == 0) {
    auto hit = lens.back.Intersect({ray.origin - vertex, ray.direction});
    if (hit) hit->point += vertex;
    return hit;
  }
  const Eigen::Matrix3d r = BackRotation(lens);
  auto hit =
      lens.back.Intersect({r.transpose() * (ray.origin - vertex), r.transpose() * ray.direction});
  if (hit) {
    hit->point = r * hit->point + vertex;
    hit->normal = r * hit->normal;
  }
  return hit;
}

LensTrace TraceThrough(const Lens& lens, const Ray& ray, double index) {
  LensTrace trace;
  const bool forward = ray.direction.z() > 0;
  const auto first = forward ? lens.front.Intersect(ray) : IntersectBack(lens, ray);
  if (!first) return trace;
  trace.first = *first;
  const auto inside = Refract(ray.direction, first->normal, 1.0 / index);
  if (!inside) {
    trace.status = RayStatus::kTotalInternalReflection;
    return trace;
  }
  trace.inside_direction = inside->normalized();
  const Ray within{first->point, trace.inside_direction};
  const auto second = forward ? IntersectBack(lens, within) : lens.front.Intersect(within);
  if (!second) return trace;
  trace.second = *second;
  const auto out = Refract(trace.inside_direction, second->normal, index);
  if (!out) {
    trace.status = RayStatus::kTotalInternalReflection;
    return trace;
  }
  trace.exit = {second->point, out->normalized()};
  trace.status = RayStatus::kOk;
  return trace;
}

LensTrace TraceThrough(const Lens& lens, const Ray& ray) {
  return TraceThrough(lens, ray, lens.medium.index_d);
}

}  // namespace lorgnette
