// SPDX-License-Identifier: Apache-2.0
#include "optics/surface.h"

#include <cmath>

#include "optics/surface_newton.h"

namespace lorgnette {
namespace {

// a*b - c*d with one rounding of the result (Kahan): the discriminant near grazing incidence.
double DifferenceOfProducts(double a, double b, double c, double d) {
  const double cd = c * d;
  const double error = std::fma(-c, d, cd);
  return std::fma(a, b, -cd) + error;
}

std::optional<SurfaceJet> JetOf(const SphereSurface& s, double x, double y) {
  const double c = s.curvature;
  const double e2 = 1.0 - c * c * (x * x + y * y);
  if (!(e2 > 0)) return std::nullopt;
  const double e = std::sqrt(e2), e3 = e2 * e;
  SurfaceJet jet;
  jet.z = c * (x * x + y * y) / (1.0 + e);
  jet.zx = c * x / e;
  jet.zy = c * y / e;
  jet.zxx = c * (1.0 - c * c * y * y) / e3;
  jet.zxy = c * c * c * x * y / e3;
  jet.zyy = c * (1.0 - c * c * x * x) / e3;
  return jet;
}

// In the torus' own axes: v along the generator meridian, u across it.
std::optional<SurfaceJet> TorusJet(double cu, double cv, double u, double v) {
  const double ev2 = 1.0 - cv * cv * v * v;
  if (!(ev2 > 0)) return std::nullopt;
  const double ev = std::sqrt(ev2);
  const double generator_sag = cv * v * v / (1.0 + ev);
  const double slope = cv * v / ev, bend = cv / (ev2 * ev);
  const double scale = 1.0 - cu * generator_sag;
  if (!(scale > 0)) return std::nullopt;
  const double circle = cu / scale;
  const double eu2 = 1.0 - circle * circle * u * u;
  if (!(eu2 > 0)) return std::nullopt;
  SurfaceJet jet;
  const double eu = std::sqrt(eu2);
  const double w = scale * eu;  // 1 - cu z
  jet.z = generator_sag + circle * u * u / (1.0 + eu);
  jet.zx = cu * u / w;
  jet.zy = scale * slope / w;
  jet.zxx = cu * (1.0 + jet.zx * jet.zx) / w;
  jet.zxy = cu * jet.zx * jet.zy / w;
  jet.zyy = (scale * bend + cu * (jet.zy * jet.zy - slope * slope)) / w;
  return jet;
}

std::optional<SurfaceJet> JetOf(const TorusSurface& s, double x, double y) {
  const double co = std::cos(s.generator_angle), si = std::sin(s.generator_angle);
  auto jet = TorusJet(s.curvature_across, s.curvature_generator, si * x - co * y, co * x + si * y);
  if (jet) *jet = RotatedJet(*jet, si, co);
  return jet;
}

// Roots of c t^2 - 2 B t + H = 0 in the form that needs no radius. Of the two crossings the one
// wanted has normal . direction of the sign of direction.z: it lies on the vertex sheet whenever
// the other one does.
std::optional<SurfaceHit> IntersectSphere(double c, const Ray& ray) {
  const Eigen::Vector3d& d = ray.direction;
  const double shift = -ray.origin.dot(d);  // to the point nearest the vertex: small numbers below
  const Eigen::Vector3d p = ray.origin + shift * d;
  const double b = d.z() - c * p.dot(d);
  const double h = c * p.squaredNorm() - 2.0 * p.z();
  double disc = DifferenceOfProducts(b, b, c, h);
  const double rounding = 4e-16 * (b * b + std::abs(c * h));
  if (!(disc >= -rounding)) return std::nullopt;
  disc = std::max(disc, 0.0);
  const double root = std::copysign(std::sqrt(disc), d.z());
  double t;
  if (std::signbit(b) == std::signbit(d.z()) || c == 0) {
    if (b + root == 0) return std::nullopt;  // parallel to a plane
    t = h / (b + root);
  } else {
    t = (b - root) / c;
  }
  SurfaceHit hit;
  hit.distance = shift + t;
  hit.point = p + t * d;
  const double w = 1.0 - c * hit.point.z();
  if (!(w > 0) || !std::isfinite(hit.distance)) return std::nullopt;
  hit.normal = Eigen::Vector3d(-c * hit.point.x(), -c * hit.point.y(), w).normalized();
  return hit;
}

}  // namespace

std::optional<SurfaceJet> Surface::Jet(double x, double y) const {
  return std::visit([&](const auto& s) { return JetOf(s, x, y); }, shape_);
}

std::optional<SurfaceHit> Surface::Intersect(const Ray& ray) const {
  if (const auto* sphere = std::get_if<SphereSurface>(&shape_)) {
    return IntersectSphere(sphere->curvature, ray);
  }
  return IntersectGraph(*this, ray);
}

Eigen::Matrix2d Surface::VertexCurvature() const {
  const SurfaceJet jet = *Jet(0, 0);
  Eigen::Matrix2d k;
  k << jet.zxx, jet.zxy, jet.zxy, jet.zyy;
  return k;
}

}  // namespace lorgnette
