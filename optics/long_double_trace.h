// SPDX-License-Identifier: Apache-2.0
// A slow, plain tracer in long double, written apart from the library: the oracle for its bounds
// and the reference of the accuracy study. Spheres, tori and conics with even terms.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "optics/lens.h"
#include "optics/ray.h"

namespace lorgnette::oracle {

using Real = long double;
using Vec = Eigen::Matrix<Real, 3, 1>;

// Height over the surface and its gradient at p, in the surface's own axes; nullopt off the sheet.
struct Height {
  Real value;
  Vec gradient;
};
inline std::optional<Height> HeightOverConic(const ConicSurface& s, const Vec& p) {
  const Real c = s.curvature, q = 1 + Real(s.conic);
  const Real r2 = p.x() * p.x() + p.y() * p.y();
  const Real e2 = 1 - q * c * c * r2;
  if (!(e2 > 0)) return std::nullopt;
  const Real e = std::sqrt(e2);
  Real z = c * r2 / (1 + e), slope = c / e, power = r2;  // slope: dz / dr over r
  for (std::size_t i = 0; i < s.even.size(); ++i) {
    z += s.even[i] * power * r2;
    slope += Real(2 * i + 4) * s.even[i] * power;
    power *= r2;
  }
  return Height{p.z() - z, Vec(-slope * p.x(), -slope * p.y(), 1)};
}
inline std::optional<Height> HeightOver(const Surface& surface, const Vec& p) {
  if (const auto* conic = std::get_if<ConicSurface>(&surface.shape())) {
    return HeightOverConic(*conic, p);
  }
  Real cu = 0, cv = 0, angle = 0;
  if (const auto* s = std::get_if<SphereSurface>(&surface.shape())) {
    cu = cv = s->curvature;
  } else {
    const auto& t = std::get<TorusSurface>(surface.shape());
    cu = t.curvature_across;
    cv = t.curvature_generator;
    angle = t.generator_angle;
  }
  const Real co = std::cos(angle), si = std::sin(angle);
  const Real v = co * p.x() + si * p.y(), u = si * p.x() - co * p.y();
  const Real ev2 = 1 - cv * cv * v * v;
  if (!(ev2 > 0)) return std::nullopt;
  const Real generator = cv * v * v / (1 + std::sqrt(ev2));
  const Real circle = cu / (1 - cu * generator);
  const Real eu2 = 1 - circle * circle * u * u;
  if (!(eu2 > 0) || !(1 - cu * generator > 0)) return std::nullopt;
  const Real z = generator + circle * u * u / (1 + std::sqrt(eu2));
  const Real zu = cu * u / (1 - cu * z);
  const Real zv = (1 - cu * generator) * cv * v / std::sqrt(ev2) / (1 - cu * z);
  return Height{p.z() - z, Vec(-(si * zu + co * zv), co * zu - si * zv, 1)};
}

struct Hit {
  Vec point, normal;
  Real distance;
};

// Newton from the plane of the vertex, halving steps that leave the sheet.
inline std::optional<Hit> Intersect(const Surface& surface, const Vec& origin, const Vec& dir) {
  Real t = dir.z() != 0 ? -origin.z() / dir.z() : 0;
  // Come in from the foot on the vertex plane along the ray until the sheet exists.
  auto h = HeightOver(surface, origin + t * dir);
  const Real nearest = -origin.dot(dir);
  for (int i = 0; !h && i < 60; ++i) {
    t += (nearest - t) / 4;
    h = HeightOver(surface, origin + t * dir);
  }
  for (int i = 0; h && i < 60; ++i) {
    const Real slope = h->gradient.dot(dir);
    if (slope == 0) return std::nullopt;
    Real step = -h->value / slope;
    auto next = HeightOver(surface, origin + (t + step) * dir);
    for (int k = 0; !next && k < 40; ++k) {
      step /= 2;
      next = HeightOver(surface, origin + (t + step) * dir);
    }
    if (!next) return std::nullopt;
    t += step;
    h = next;
    if (std::abs(step) < 1e-17L) break;
  }
  if (!h || std::abs(h->value) > 1e-14L) return std::nullopt;
  return Hit{origin + t * dir, h->gradient.normalized(), t};
}

inline std::optional<Vec> Refract(const Vec& dir, const Vec& normal, Real eta) {
  const Real c = dir.dot(normal);
  const Real after2 = 1 - eta * eta * (1 - c * c);
  if (after2 < 0) return std::nullopt;
  return Vec(eta * dir + (std::copysign(std::sqrt(after2), c) - eta * c) * normal).normalized();
}

// Rotation of the back surface about its vertex: about +x, then about +y.
inline Eigen::Matrix<Real, 3, 3> BackTilt(const Lens& lens) {
  const Real a = lens.back_tilt_x, b = lens.back_tilt_y;
  Eigen::Matrix<Real, 3, 3> rx, ry;
  rx << 1, 0, 0, 0, std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a);
  ry << std::cos(b), 0, std::sin(b), 0, 1, 0, -std::sin(b), 0, std::cos(b);
  return ry * rx;
}

inline std::optional<Hit> IntersectFace(const Lens& lens, bool back, const Vec& origin,
                                        const Vec& dir) {
  if (!back) return Intersect(lens.front, origin, dir);
  const auto r = BackTilt(lens);
  const Vec vertex(0, 0, lens.center_thickness_mm);
  auto hit = Intersect(lens.back, r.transpose() * (origin - vertex), r.transpose() * dir);
  if (hit) {
    hit->point = (r * hit->point + vertex).eval();
    hit->normal = (r * hit->normal).eval();
  }
  return hit;
}

struct Trace {
  RayStatus status = RayStatus::kMissesSurface;
  Hit first, second;
  Vec inside, exit;
  Real cosine_first = 0, cosine_second = 0;  // of incidence
};
inline Trace TraceLens(const Lens& lens, const Vec& origin, const Vec& dir, Real index) {
  Trace trace;
  const bool forward = dir.z() > 0;
  const auto first = IntersectFace(lens, !forward, origin, dir);
  if (!first) return trace;
  trace.first = *first;
  trace.cosine_first = std::abs(dir.dot(first->normal));
  const auto inside = Refract(dir, first->normal, 1 / index);
  if (!inside) {
    trace.status = RayStatus::kTotalInternalReflection;
    return trace;
  }
  trace.inside = *inside;
  const auto second = IntersectFace(lens, forward, first->point, *inside);
  if (!second) return trace;
  trace.second = *second;
  trace.cosine_second = std::abs(inside->dot(second->normal));
  const auto exit = Refract(*inside, second->normal, index);
  trace.status = exit ? RayStatus::kOk : RayStatus::kTotalInternalReflection;
  if (exit) trace.exit = *exit;
  return trace;
}

}  // namespace lorgnette::oracle
