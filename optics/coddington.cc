// SPDX-License-Identifier: Apache-2.0
#include "optics/coddington.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "base/units.h"

namespace lorgnette {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Basis = Eigen::Matrix<double, 3, 2>;

// What refracts at one surface: bend turned so that its normal goes along the light.
struct Interface {
  SurfaceBend bend;
  double index_before, index_after;
};

SurfaceBend Facing(const SurfaceBend& bend, const Vector3d& direction) {
  if (bend.normal.dot(direction) >= 0) return bend;
  return {-bend.normal, -bend.curvature};
}

// A unit vector across both d and n; any across n where they are parallel.
Vector3d AcrossBoth(const Vector3d& d, const Vector3d& n) {
  // Below this the cross product is rounding, and every direction across n will do.
  constexpr double kParallel = 1e-14;
  Vector3d e = d.cross(n);
  if (e.norm() < kParallel) return AcrossBasis(n).col(0);
  e.normalize();
  // A small cross product is not quite across n; this takes the rest out.
  return (e - e.dot(n) * n).normalized();
}

// Where a differential ray lands when the surface's normal there is n: only along the ray can the
// point move to stay on the surface.
void Land(const Vector3d& direction, double distance, const Vector3d& n, RayDifferential& d) {
  const Basis moved = d.origin + distance * d.direction;
  d.origin = moved - direction * (n.transpose() * moved) / n.dot(direction);
}

// Derivative of the refracted direction eta d + (m' - eta m) n, m = n.d.
void Bend(const Vector3d& in, const Vector3d& out, const Interface& face, RayDifferential& d) {
  const double eta = face.index_before / face.index_after;
  const Vector3d& n = face.bend.normal;
  const double m = n.dot(in), m_out = n.dot(out);
  const Basis dn = -face.bend.curvature * d.origin;
  const Eigen::RowVector2d dm = n.transpose() * d.direction + in.transpose() * dn;
  const Eigen::RowVector2d dk = (eta * eta * m / m_out - eta) * dm;
  d.direction = eta * d.direction + n * dk + (m_out - eta * m) * dn;
}

// The surface that a leg of the trace ends on, facing the light.
std::optional<Interface> InterfaceAt(const Lens& lens, bool front, const Vector3d& point,
                                     const Vector3d& direction, double before, double after) {
  const auto bend = front ? FrontBendAt(lens, point) : BackBendAt(lens, point);
  if (!bend) return std::nullopt;
  return Interface{Facing(*bend, direction), before, after};
}

}  // namespace

Basis AcrossBasis(const Vector3d& direction) {
  const Vector3d& d = direction;
  const Vector3d away = std::abs(d.x()) < std::abs(d.y()) ? Vector3d::UnitX() : Vector3d::UnitY();
  Basis basis;
  basis.col(0) = away.cross(d).normalized();
  basis.col(1) = d.cross(basis.col(0));
  return basis;
}

Wavefront SphericalWave(const Ray& chief, double vergence_D) {
  const Vector3d& d = chief.direction;
  return {chief, vergence_D * (Matrix3d::Identity() - d * d.transpose())};
}

Wavefront Propagated(const Wavefront& wavefront, double distance_mm, double index) {
  const Vector3d& d = wavefront.chief.direction;
  Wavefront moved = wavefront;
  moved.chief.origin += distance_mm * d;
  const Basis e = AcrossBasis(d);
  const Matrix2d v = e.transpose() * wavefront.vergence_D * e;
  const Matrix2d m = Matrix2d::Identity() - distance_mm / 1000 / index * v;
  if (m.determinant() == 0) {
    moved.vergence_D.setConstant(kInfinity);
    return moved;
  }
  const Matrix2d after = v * m.inverse();
  moved.vergence_D = e * (0.5 * (after + after.transpose())) * e.transpose();
  return moved;
}

std::optional<SurfaceBend> BendAt(const Surface& surface, double x, double y,
                                  const Matrix3d& rotation) {
  const auto jet = surface.Jet(x, y);
  if (!jet) return std::nullopt;
  const Vector3d gradient(-jet->zx, -jet->zy, 1);
  const double length = gradient.norm();
  const Vector3d n = gradient / length;
  Matrix3d hessian = Matrix3d::Zero();
  hessian(0, 0) = jet->zxx;
  hessian(1, 1) = jet->zyy;
  hessian(0, 1) = hessian(1, 0) = jet->zxy;
  const Matrix3d tangent = Matrix3d::Identity() - n * n.transpose();
  return SurfaceBend{rotation * n,
                     rotation * (tangent * hessian * tangent / length) * rotation.transpose()};
}

std::optional<SurfaceBend> FrontBendAt(const Lens& lens, const Vector3d& point) {
  return BendAt(lens.front, point.x(), point.y(), Matrix3d::Identity());
}

std::optional<SurfaceBend> BackBendAt(const Lens& lens, const Vector3d& point) {
  const Matrix3d rotation = BackRotation(lens);
  const Vector3d own = rotation.transpose() * (point - Vector3d(0, 0, lens.center_thickness_mm));
  return BendAt(lens.back, own.x(), own.y(), rotation);
}

Matrix3d RefractedVergence(const Matrix3d& vergence_D, const SurfaceBend& surface,
                           const Vector3d& in, const Vector3d& out, double index_before,
                           double index_after) {
  const SurfaceBend bend = Facing(surface, in);
  const Vector3d& n = bend.normal;
  Basis before, on, after;  // across the ray in, on the surface, across the ray out
  before.col(0) = on.col(0) = after.col(0) = AcrossBoth(in, n);
  before.col(1) = in.cross(before.col(0));
  on.col(1) = n.cross(on.col(0));
  after.col(1) = out.cross(after.col(0));
  const double cosine = n.dot(in), cosine_after = n.dot(out);
  const double obliquity_D = 1000 * (index_after * cosine_after - index_before * cosine);

  Matrix2d m = before.transpose() * vergence_D * before;
  m(0, 1) *= cosine;
  m(1, 0) *= cosine;
  m(1, 1) *= cosine * cosine;
  m += obliquity_D * (on.transpose() * bend.curvature * on);
  m(0, 1) /= cosine_after;
  m(1, 0) /= cosine_after;
  m(1, 1) /= cosine_after * cosine_after;
  return after * m * after.transpose();
}

std::optional<Wavefront> WavefrontThrough(const Lens& lens, double index, const LensTrace& rays,
                                          const Wavefront& in) {
  const bool front_first = in.chief.direction.z() > 0;
  const auto bend = [&](bool front, const Vector3d& point) {
    return front ? FrontBendAt(lens, point) : BackBendAt(lens, point);
  };
  const auto first = bend(front_first, rays.first.point);
  const auto second = bend(!front_first, rays.second.point);
  if (!first || !second) return std::nullopt;
  const Vector3d& inside = rays.inside_direction;
  Wavefront wave{{rays.first.point, inside},
                 RefractedVergence(in.vergence_D, *first, in.chief.direction, inside, 1, index)};
  wave = Propagated(wave, (rays.second.point - rays.first.point).dot(inside), index);
  wave.vergence_D =
      RefractedVergence(wave.vergence_D, *second, inside, rays.exit.direction, index, 1);
  wave.chief = rays.exit;
  return wave;
}

WavefrontTrace TraceWavefront(const Lens& lens, double index, const Wavefront& in) {
  WavefrontTrace trace;
  trace.rays = TraceThrough(lens, in.chief, index);
  trace.status = trace.rays.status;
  if (trace.status != RayStatus::kOk) return trace;
  const double reach = (trace.rays.first.point - in.chief.origin).dot(in.chief.direction);
  const auto exit = WavefrontThrough(lens, index, trace.rays, Propagated(in, reach, 1));
  if (exit) {
    trace.exit = *exit;
  } else {
    trace.status = RayStatus::kMissesSurface;
  }
  return trace;
}

DifferentialTrace TraceDifferential(const Lens& lens, double index, const Ray& ray,
                                    const RayDifferential& in) {
  DifferentialTrace trace;
  const LensTrace rays = TraceThrough(lens, ray, index);
  trace.status = rays.status;
  if (rays.status != RayStatus::kOk) return trace;
  const bool forward = ray.direction.z() > 0;
  const auto first = InterfaceAt(lens, forward, rays.first.point, ray.direction, 1, index);
  const auto second =
      InterfaceAt(lens, !forward, rays.second.point, rays.inside_direction, index, 1);
  if (!first || !second) {
    trace.status = RayStatus::kMissesSurface;
    return trace;
  }
  RayDifferential d = in;
  Land(ray.direction, (rays.first.point - ray.origin).dot(ray.direction), first->bend.normal, d);
  Bend(ray.direction, rays.inside_direction, *first, d);
  Land(rays.inside_direction, (rays.second.point - rays.first.point).dot(rays.inside_direction),
       second->bend.normal, d);
  Bend(rays.inside_direction, rays.exit.direction, *second, d);
  trace.exit = rays.exit;
  trace.differential = d;
  return trace;
}

RayDifferential ParallelDifferential(const Ray& ray) {
  return {AcrossBasis(ray.direction), Basis::Zero()};
}

Matrix3d VergenceOf(const Ray& ray, const RayDifferential& differential) {
  const Basis e = AcrossBasis(ray.direction);
  const Matrix2d heights = e.transpose() * differential.origin;
  const Matrix2d slopes = e.transpose() * differential.direction;
  if (heights.determinant() == 0) return Matrix3d::Constant(kInfinity);
  const Matrix2d v = -1000 * slopes * heights.inverse();
  return e * (0.5 * (v + v.transpose())) * e.transpose();
}

}  // namespace lorgnette
