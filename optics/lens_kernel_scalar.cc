// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_kernel_scalar.h"

#include "optics/trace.h"

namespace lorgnette::kernel {
namespace {

using Eigen::Vector3d;

template <typename T>
Ray RayAt(const RayArrays<const T>& in, std::size_t i) {
  return {Vector3d(double(in.ox[i]), double(in.oy[i]), double(in.oz[i])),
          Vector3d(double(in.dx[i]), double(in.dy[i]), double(in.dz[i]))};
}

// A ray that can be traced at all: finite, and its direction about unit.
bool IsRay(const Ray& ray) {
  return ray.origin.allFinite() && ray.origin.squaredNorm() < 1e12 &&
         ray.direction.squaredNorm() > 0.5 && ray.direction.squaredNorm() < 2;
}

template <typename T>
void PutPoint(const RayArrays<T>& a, std::size_t i, const Vector3d& p) {
  a.ox[i] = T(p.x());
  a.oy[i] = T(p.y());
  a.oz[i] = T(p.z());
}
template <typename T>
void PutDirection(const RayArrays<T>& a, std::size_t i, const Vector3d& d) {
  a.dx[i] = T(d.x());
  a.dy[i] = T(d.y());
  a.dz[i] = T(d.z());
}

}  // namespace

template <typename T>
void TraceLensScalar(const Lens& lens, double index, const RayArrays<const T>& in, std::size_t n,
                     const LensBatchOutput<T>& out) {
  const Vector3d zero = Vector3d::Zero();
  const bool forward = in.dz[0] > 0;
  for (std::size_t i = 0; i < n; ++i) {
    Ray ray = RayAt(in, i);
    LensTrace trace;
    bool first_hit = false, second_hit = false;
    if (IsRay(ray) && (forward ? ray.direction.z() > 0 : ray.direction.z() < 0)) {
      ray.direction.normalize();
      trace = TraceThrough(lens, ray, index);
      first_hit = trace.first.normal.z() > 0;
      second_hit = trace.second.normal.z() > 0;
    }
    const bool ok = trace.status == RayStatus::kOk;
    out.status[i] = static_cast<std::uint8_t>(trace.status);
    PutPoint(out.exit, i, ok ? trace.exit.origin : zero);
    PutDirection(out.exit, i, ok ? trace.exit.direction : zero);
    if (out.first != nullptr) {
      PutPoint(*out.first, i, first_hit ? trace.first.point : zero);
      PutDirection(*out.first, i, first_hit ? trace.first.normal : zero);
    }
    if (out.inside != nullptr) {
      PutPoint(*out.inside, i, second_hit ? trace.second.point : zero);
      PutDirection(*out.inside, i, second_hit ? trace.inside_direction : zero);
    }
    if (out.second != nullptr)
      PutDirection(*out.second, i, second_hit ? trace.second.normal : zero);
    if (out.first_reflectance != nullptr) {
      out.first_reflectance[i] =
          first_hit ? T(FresnelReflectance(ray.direction.dot(trace.first.normal), 1 / index))
                    : T(0);
    }
    if (out.second_reflectance != nullptr) {
      out.second_reflectance[i] =
          second_hit ? T(FresnelReflectance(trace.inside_direction.dot(trace.second.normal), index))
                     : T(0);
    }
  }
}

template <typename T>
void TraceFaceScalar(const Lens& lens, LensFace face, double index, const RayArrays<const T>& in,
                     std::size_t n, const FaceBatchOutput<T>& out) {
  const Vector3d zero = Vector3d::Zero();
  const double sense = face == LensFace::kBack ? 1 : -1;
  for (std::size_t i = 0; i < n; ++i) {
    Ray ray = RayAt(in, i);
    std::optional<SurfaceHit> hit;
    if (IsRay(ray)) {
      ray.direction.normalize();
      hit = face == LensFace::kBack ? IntersectBack(lens, ray) : lens.front.Intersect(ray);
      if (hit && !(hit->distance > 0 && sense * hit->normal.dot(ray.direction) > 0)) hit.reset();
    }
    const auto after = hit ? Refract(ray.direction, hit->normal, index) : std::nullopt;
    const RayStatus status = !hit    ? RayStatus::kMissesSurface
                             : after ? RayStatus::kOk
                                     : RayStatus::kTotalInternalReflection;
    out.status[i] = static_cast<std::uint8_t>(status);
    PutPoint(out.hit, i, hit ? hit->point : zero);
    PutDirection(out.hit, i, hit ? hit->normal : zero);
    if (out.refracted != nullptr) PutDirection(*out.refracted, i, after ? *after : zero);
    if (out.reflected != nullptr) {
      PutDirection(*out.reflected, i, hit ? Reflect(ray.direction, hit->normal) : zero);
    }
    if (out.reflectance != nullptr) {
      out.reflectance[i] =
          hit ? T(FresnelReflectance(ray.direction.dot(hit->normal), index)) : T(0);
    }
  }
}

template void TraceLensScalar(const Lens&, double, const RayArrays<const float>&, std::size_t,
                              const LensBatchOutput<float>&);
template void TraceLensScalar(const Lens&, double, const RayArrays<const double>&, std::size_t,
                              const LensBatchOutput<double>&);
template void TraceFaceScalar(const Lens&, LensFace, double, const RayArrays<const float>&,
                              std::size_t, const FaceBatchOutput<float>&);
template void TraceFaceScalar(const Lens&, LensFace, double, const RayArrays<const double>&,
                              std::size_t, const FaceBatchOutput<double>&);

}  // namespace lorgnette::kernel
