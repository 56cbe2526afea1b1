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

// The sphere c |q|^2 = 2 n . q through the origin with normal n there: roots of
// c t^2 - 2 B t + H = 0 in the form that needs no radius. Of the two crossings the one wanted has
// normal . direction of the sign of n . direction; it lies on the vertex sheet whenever the other
// one does.
std::optional<SurfaceHit> IntersectSphere(double c, const Eigen::Vector3d& n, const Ray& ray) {
  const Eigen::Vector3d& d = ray.direction;
  const double shift = -ray.origin.dot(d);  // to the point nearest the vertex: small numbers below
  const Eigen::Vector3d p = ray.origin + shift * d;
  const double along = n.dot(d);
  const double b = along - c * p.dot(d);
  const double h = c * p.squaredNorm() - 2.0 * n.dot(p);
  double disc = DifferenceOfProducts(b, b, c, h);
  const double rounding = 4e-16 * (b * b + std::abs(c * h));
  if (!(disc >= -rounding)) return std::nullopt;
  disc = std::max(disc, 0.0);
  const double root = std::copysign(std::sqrt(disc), along);
  double t;
  if (std::signbit(b) == std::signbit(along) || c == 0) {
    if (b + root == 0) return std::nullopt;  // parallel to a plane
    t = h / (b + root);
  } else {
    t = (b - root) / c;
  }
  SurfaceHit hit;
  hit.distance = shift + t;
  hit.point = p + t * d;
  if (!(1.0 - c * n.dot(hit.point) > 0) || !std::isfinite(hit.distance)) return std::nullopt;
  hit.normal = (n - c * hit.point).normalized();
  return hit;
}

const Eigen::Vector3d kAxis(0, 0, 1);

// Main sphere outside the segment, segment inside; a ray that passes neither hits the ledge.
std::optional<SurfaceHit> IntersectBifocal(const BifocalSurface& s, const Ray& ray) {
  const BifocalSurface::Frame frame = s.SegmentFrame();
  auto segment = IntersectSphere(s.curvature_segment, frame.normal,
                                 {ray.origin - frame.vertex, ray.direction});
  if (segment) {
    segment->point += frame.vertex;
    if (!s.Holds(frame, segment->point)) segment.reset();
  }
  auto main = IntersectSphere(s.curvature, kAxis, ray);
  if (main) {
    const auto jet = JetOf(s, main->point.x(), main->point.y());
    // The graph over this place is the segment: the main sphere is not there.
    if (!jet || s.Holds(frame, {main->point.x(), main->point.y(), jet->z})) main.reset();
  }
  if (segment && main) return segment->distance < main->distance ? segment : main;
  return segment ? segment : main;
}

}  // namespace

std::optional<SurfaceJet> Surface::Jet(double x, double y) const {
  return std::visit([&](const auto& s) { return JetOf(s, x, y); }, shape_);
}

std::optional<SurfaceHit> Surface::Intersect(const Ray& ray) const {
  if (const auto* sphere = std::get_if<SphereSurface>(&shape_)) {
    return IntersectSphere(sphere->curvature, kAxis, ray);
  }
  if (const auto* bifocal = std::get_if<BifocalSurface>(&shape_)) {
    return IntersectBifocal(*bifocal, ray);
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
