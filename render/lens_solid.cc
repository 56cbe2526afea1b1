// SPDX-License-Identifier: Apache-2.0
#include "render/lens_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/units.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

// A ray steeper than this against the axis can cross a surface twice inside the glass; the
// surface's own intersection reports one crossing, so that such rays are scanned.
constexpr double kSteep = 0.5;
constexpr int kScanSteps = 48;

// The parts of a ray inside an axis-aligned box; empty when t0 > t1.
struct Span {
  double t0, t1;
};
Span InBox(const Ray& ray, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Span span{-kInfinity, kInfinity};
  for (int k = 0; k < 3; ++k) {
    if (ray.direction[k] == 0) {
      if (ray.origin[k] < low[k] || ray.origin[k] > high[k]) return {1, 0};
      continue;
    }
    double a = (low[k] - ray.origin[k]) / ray.direction[k];
    double b = (high[k] - ray.origin[k]) / ray.direction[k];
    if (a > b) std::swap(a, b);
    span.t0 = std::max(span.t0, a);
    span.t1 = std::min(span.t1, b);
  }
  return span;
}

struct Crossings {
  int count = 0;
  SurfaceHit hits[4];
  // Keeps the hits in order of distance.
  void Add(const SurfaceHit& hit) {
    if (count == 4) return;
    int at = count++;
    for (; at > 0 && hits[at - 1].distance > hit.distance; --at) hits[at] = hits[at - 1];
    hits[at] = hit;
  }
};

// Both roots on the vertex sheet of c t^2 - 2 B t + H = 0, taken about the point of the ray nearest
// the vertex (optics/surface.cc has the derivation; here no root is preferred).
Crossings CrossSphere(double c, const Ray& ray) {
  Crossings out;
  const Eigen::Vector3d& d = ray.direction;
  const double shift = -ray.origin.dot(d);
  const Eigen::Vector3d p = ray.origin + shift * d;
  const double b = d.z() - c * p.dot(d);
  const double h = c * p.squaredNorm() - 2 * p.z();
  const double discriminant = b * b - c * h;
  if (!(discriminant >= 0)) return out;
  const double q = b + std::copysign(std::sqrt(discriminant), b);
  const double roots[2] = {q != 0 ? h / q : kInfinity, c != 0 ? q / c : kInfinity};
  for (const double t : roots) {
    if (!std::isfinite(t)) continue;
    SurfaceHit hit;
    hit.distance = shift + t;
    hit.point = p + t * d;
    const double w = 1 - c * hit.point.z();
    if (!(w > 0)) continue;
    hit.normal = Eigen::Vector3d(-c * hit.point.x(), -c * hit.point.y(), w).normalized();
    out.Add(hit);
  }
  return out;
}

// Sign changes of z - sag along the ray between t0 and t1, each bisected to the last bit but a few.
Crossings Scan(const Surface& surface, const Ray& ray, double t0, double t1) {
  Crossings out;
  const auto height = [&](double t) {
    const Eigen::Vector3d p = ray.origin + t * ray.direction;
    const auto jet = surface.Jet(p.x(), p.y());
    return jet ? p.z() - jet->z : std::numeric_limits<double>::quiet_NaN();
  };
  double t_before = t0, before = height(t0);
  for (int i = 1; i <= kScanSteps; ++i) {
    const double t = t0 + (t1 - t0) * i / kScanSteps;
    const double now = height(t);
    if ((before > 0 && now <= 0) || (before < 0 && now >= 0)) {
      double low = t_before, high = t, low_value = before;
      for (int k = 0; k < 60 && high - low > 1e-13; ++k) {
        const double middle = 0.5 * (low + high);
        const double value = height(middle);
        if ((value > 0) == (low_value > 0)) {
          low = middle;
          low_value = value;
        } else {
          high = middle;
        }
      }
      SurfaceHit hit;
      hit.distance = 0.5 * (low + high);
      hit.point = ray.origin + hit.distance * ray.direction;
      if (const auto jet = surface.Jet(hit.point.x(), hit.point.y())) {
        hit.normal = Eigen::Vector3d(-jet->zx, -jet->zy, 1).normalized();
        out.Add(hit);
      }
    }
    t_before = t;
    before = now;
  }
  return out;
}

Crossings CrossSurface(const Surface& surface, const Ray& ray, double t0, double t1) {
  if (const auto* sphere = std::get_if<SphereSurface>(&surface.shape())) {
    return CrossSphere(sphere->curvature, ray);
  }
  if (std::abs(ray.direction.z()) < kSteep) return Scan(surface, ray, t0, t1);
  Crossings out;
  if (const auto hit = surface.Intersect(ray)) out.Add(*hit);
  return out;
}

}  // namespace

LensSolid::LensSolid(const Lens& lens, const std::vector<Eigen::Vector2d>& contour_mm,
                     const Eigen::Isometry3d& head_from_lens)
    : lens_(lens),
      contour_(contour_mm),
      head_from_lens_(head_from_lens),
      lens_from_head_(head_from_lens.inverse()),
      back_rotation_(BackRotation(lens)),
      back_tilted_(lens.back_tilt_x != 0 || lens.back_tilt_y != 0) {
  if (std::holds_alternative<SphereSurface>(lens.back.shape()) ||
      std::holds_alternative<TorusSurface>(lens.back.shape())) {
    const Eigen::Matrix2d curvature = lens.back.VertexCurvature();
    back_bulges_inward_ = curvature.trace() >= 0 && curvature.determinant() >= 0;
  }
  // The surfaces are monotone from vertex to edge along each meridian (or flat), so that their
  // extremes lie on the contour or at the vertex; a margin covers a vertex far from the contour.
  double low = 0, high = lens.center_thickness_mm;
  for (const Eigen::Vector2d& p : contour_.polygon()) {
    for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      for (const SolidFace face : {SolidFace::kFront, SolidFace::kBack}) {
        if (const auto z = FaceHeight(face, s * p.x(), s * p.y())) {
          low = std::min(low, *z);
          high = std::max(high, *z);
        }
      }
    }
  }
  constexpr double kMargin_mm = 0.05;
  low_ = {contour_.low().x(), contour_.low().y(), low - kMargin_mm};
  high_ = {contour_.high().x(), contour_.high().y(), high + kMargin_mm};
}

// First crossing of one face's surface, inside the contour, in (kStart_mm, t_max).
std::optional<SolidHit> LensSolid::CrossFace(SolidFace face, const Ray& ray, double t_max) const {
  const bool back = face == SolidFace::kBack;
  Ray own = ray;
  if (back) {
    own.origin.z() -= lens_.center_thickness_mm;
    if (back_tilted_) {
      own.origin = back_rotation_.transpose() * own.origin;
      own.direction = back_rotation_.transpose() * own.direction;
    }
  }
  Crossings crossings = CrossSurface(back ? lens_.back : lens_.front, own, 0, t_max);
  for (int i = 0; i < crossings.count; ++i) {
    SurfaceHit& hit = crossings.hits[i];
    if (!(hit.distance > kStart_mm && hit.distance < t_max)) continue;
    const Eigen::Vector3d point = ray.origin + hit.distance * ray.direction;
    if (!contour_.Contains(point.x(), point.y())) continue;
    if (back && back_tilted_) hit.normal = back_rotation_ * hit.normal;
    return SolidHit{face, hit.distance, point, back ? hit.normal : Eigen::Vector3d(-hit.normal)};
  }
  return std::nullopt;
}

// z of a face above (x, y); nullopt outside its domain.
std::optional<double> LensSolid::FaceHeight(SolidFace face, double x, double y) const {
  if (face == SolidFace::kFront) {
    const auto jet = lens_.front.Jet(x, y);
    return jet ? std::optional<double>(jet->z) : std::nullopt;
  }
  if (!back_tilted_) {
    const auto jet = lens_.back.Jet(x, y);
    return jet ? std::optional<double>(lens_.center_thickness_mm + jet->z) : std::nullopt;
  }
  const auto hit = IntersectBack(lens_, {{x, y, 0}, {0, 0, 1}});
  return hit ? std::optional<double>(hit->point.z()) : std::nullopt;
}

std::optional<SolidHit> LensSolid::Enter(const Ray& ray) const {
  const Span span = InBox(ray, low_, high_);
  if (!(span.t0 <= span.t1) || span.t1 <= kStart_mm) return std::nullopt;
  // Most rays that cross the box beside the glass stay beside the contour all the way.
  const double t0 = std::max(span.t0, 0.0);
  const Eigen::Vector2d middle = (ray.origin + 0.5 * (t0 + span.t1) * ray.direction).head<2>();
  if (contour_.OutsideBy(middle.x(), middle.y()) >
      0.5 * (span.t1 - t0) * ray.direction.head<2>().norm()) {
    return std::nullopt;
  }
  // Distances are kept about the box, so that a far camera costs no digits.
  const double shift = std::max(span.t0 - 1.0, 0.0);
  const Ray near{ray.origin + shift * ray.direction, ray.direction};
  std::optional<SolidHit> best;
  double t_max = span.t1 - shift + 1.0;
  const auto take = [&](const std::optional<SolidHit>& hit) {
    if (hit && (!best || hit->distance < best->distance) && hit->normal.dot(ray.direction) < 0) {
      best = hit;
      t_max = hit->distance;
    }
  };
  take(CrossFace(SolidFace::kFront, near, t_max));
  take(CrossFace(SolidFace::kBack, near, t_max));
  // The wall, only when the ray comes from outside the cylinder over the contour.
  if (!contour_.Contains(near.origin.x(), near.origin.y())) {
    double t_min = kStart_mm;
    while (const auto crossing = contour_.FirstCrossing(near.origin.head<2>(),
                                                        near.direction.head<2>(), t_min, t_max)) {
      const Eigen::Vector3d point = near.origin + crossing->t * near.direction;
      const auto front = FaceHeight(SolidFace::kFront, point.x(), point.y());
      const auto back = FaceHeight(SolidFace::kBack, point.x(), point.y());
      if (front && back && point.z() >= *front && point.z() <= *back) {
        take(SolidHit{
            SolidFace::kWall, crossing->t, point, {crossing->normal.x(), crossing->normal.y(), 0}});
        break;
      }
      t_min = crossing->t + kStart_mm;
    }
  }
  if (best) best->distance += shift;
  return best;
}

std::optional<SolidHit> LensSolid::Leave(const Ray& ray) const {
  std::optional<SolidHit> best;
  double t_max = (high_ - low_).norm() + 1;
  const auto take = [&](const std::optional<SolidHit>& hit) {
    if (hit && hit->normal.dot(ray.direction) > 0) {
      best = hit;
      t_max = hit->distance;
    }
  };
  take(CrossFace(SolidFace::kFront, ray, t_max));
  take(CrossFace(SolidFace::kBack, ray, t_max));
  const double reach = t_max * ray.direction.head<2>().norm();
  if (contour_.Clearance(ray.origin.x(), ray.origin.y()) < reach) {
    if (const auto crossing = contour_.FirstCrossing(ray.origin.head<2>(), ray.direction.head<2>(),
                                                     kStart_mm, t_max)) {
      take(SolidHit{SolidFace::kWall,
                    crossing->t,
                    ray.origin + crossing->t * ray.direction,
                    {crossing->normal.x(), crossing->normal.y(), 0}});
    }
  }
  return best;
}

}  // namespace lorgnette
