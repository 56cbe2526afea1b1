// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_kernel.h"

#include <array>
#include <cmath>
#include <memory>
#include <type_traits>
#include <variant>

#include "base/units.h"
#include "optics/lens_kernel_job.h"
#include "optics/lens_kernel_scalar.h"
#include "optics/ray.h"
#include "optics/trace.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optics/lens_kernel.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, by Highway's rule.
#include <hwy/highway.h>

#include "optics/lens_kernel_face-inl.h"
#include "optics/lens_kernel_graph-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lorgnette::kernel {
namespace HWY_NAMESPACE {

// After an interface: direction, whether it refracts at all, and the cosines for Fresnel.
template <class D>
struct Refraction {
  hn::Mask<D> ok;
  Vec3<D> direction;
  hn::Vec<D> along;  // cosine after, with the sense's sign; 0 on total reflection
};

// eta = n_before / n_after; `difference` = (1 - eta)(1 + eta), exact for eta = 1.
template <class D>
LORGNETTE_KERNEL_INLINE Refraction<D> RefractAt(D d, const FaceHit<D>& hit, const Vec3<D>& dir,
                                                hn::Vec<D> eta, hn::Vec<D> difference,
                                                hn::Vec<D> sense) {
  const auto eta_cosine = hn::Mul(eta, hit.cosine);
  const auto after2 = hn::MulAdd(eta_cosine, eta_cosine, difference);
  Refraction<D> r;
  r.ok = hn::Ge(after2, hn::Zero(d));
  r.along = hn::Mul(sense, QuickSqrt(d, hn::Max(after2, hn::Zero(d))));
  const auto k = hn::Sub(r.along, eta_cosine);
  r.direction = {hn::MulAdd(eta, dir.x, hn::Mul(k, hit.normal.x)),
                 hn::MulAdd(eta, dir.y, hn::Mul(k, hit.normal.y)),
                 hn::MulAdd(eta, dir.z, hn::Mul(k, hit.normal.z))};
  return r;
}

// Unpolarised reflectance; 1 on total reflection, where the cosine after is 0.
template <class D>
LORGNETTE_KERNEL_INLINE hn::Vec<D> Reflectance(D d, hn::Vec<D> before, hn::Vec<D> after,
                                               hn::Vec<D> eta) {
  const auto eb = hn::Mul(eta, before), ea = hn::Mul(eta, after);
  const auto rs = hn::Div(hn::Sub(eb, after), hn::Add(eb, after));
  const auto rp = hn::Div(hn::Sub(before, ea), hn::Add(before, ea));
  const auto mean = hn::Mul(hn::Set(d, hn::TFromD<D>(0.5)), hn::MulAdd(rs, rs, hn::Mul(rp, rp)));
  return hn::IfThenElse(hn::Eq(after, hn::Zero(d)), hn::Set(d, 1), mean);
}

template <class D, class T>
LORGNETTE_KERNEL_INLINE Vec3<D> LoadPoints(D d, const RayArrays<T>& a, std::size_t i) {
  return {hn::LoadU(d, a.ox + i), hn::LoadU(d, a.oy + i), hn::LoadU(d, a.oz + i)};
}
template <class D, class T>
LORGNETTE_KERNEL_INLINE Vec3<D> LoadDirections(D d, const RayArrays<T>& a, std::size_t i) {
  return {hn::LoadU(d, a.dx + i), hn::LoadU(d, a.dy + i), hn::LoadU(d, a.dz + i)};
}
template <class D, class T>
LORGNETTE_KERNEL_INLINE void StorePoints(D d, hn::Mask<D> ok, const Vec3<D>& v, T offset_z,
                                         const RayArrays<T>& a, std::size_t i) {
  hn::StoreU(hn::IfThenElseZero(ok, v.x), d, a.ox + i);
  hn::StoreU(hn::IfThenElseZero(ok, v.y), d, a.oy + i);
  hn::StoreU(hn::IfThenElseZero(ok, hn::Add(v.z, hn::Set(d, offset_z))), d, a.oz + i);
}
template <class D, class T>
LORGNETTE_KERNEL_INLINE void StoreDirections(D d, hn::Mask<D> ok, const Vec3<D>& v,
                                             const RayArrays<T>& a, std::size_t i) {
  hn::StoreU(hn::IfThenElseZero(ok, v.x), d, a.dx + i);
  hn::StoreU(hn::IfThenElseZero(ok, v.y), d, a.dy + i);
  hn::StoreU(hn::IfThenElseZero(ok, v.z), d, a.dz + i);
}

template <class D>
LORGNETTE_KERNEL_INLINE void StoreStatus(D d, hn::Mask<D> reached, hn::Mask<D> refracted,
                                         std::uint8_t* status) {
  using T = hn::TFromD<D>;
  constexpr auto kMiss = T(static_cast<int>(RayStatus::kMissesSurface));
  constexpr auto kTotal = T(static_cast<int>(RayStatus::kTotalInternalReflection));
  if (HWY_LIKELY(hn::AllTrue(d, hn::And(reached, refracted)))) {
    for (std::size_t k = 0; k < hn::Lanes(d); ++k) status[k] = 0;
    return;
  }
  HWY_ALIGN T code[HWY_MAX_BYTES / sizeof(T)];
  hn::Store(
      hn::IfThenElse(reached, hn::IfThenZeroElse(refracted, hn::Set(d, kTotal)), hn::Set(d, kMiss)),
      d, code);
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) status[k] = static_cast<std::uint8_t>(code[k]);
}

// A direction is taken as unit; one so long that squares could overflow is no ray.
template <class D>
LORGNETTE_KERNEL_INLINE hn::Mask<D> IsDirection(D d, const Vec3<D>& dir) {
  return hn::Lt(Dot<D>(dir, dir), hn::Set(d, 2));
}

// One register of rays through the lens, from `in` at i to `out` at i.
template <class D, class First, class Second, class T = hn::TFromD<D>>
LORGNETTE_KERNEL_INLINE void TraceOne(D d, const First& first, const Second& second,
                                      const LensJob<T>& job, const RayArrays<const T>& in,
                                      const LensBatchOutput<T>& out, std::size_t i) {
  const auto sense = hn::Set(d, job.sense);
  const auto dir = LoadDirections(d, in, i);
  auto origin = LoadPoints(d, in, i);
  origin.z = hn::Sub(origin.z, hn::Set(d, job.first.vertex_z));
  // Start at the point nearest the vertex: small numbers from here on, whatever the distance.
  const auto p = Along<D>(origin, hn::Neg(Dot<D>(origin, dir)), dir);

  auto hit1 = first.Intersect(p, dir);
  const auto same_way = hn::Gt(hn::Mul(dir.z, sense), hn::Zero(d));
  hit1.ok = hn::And(hit1.ok, hn::And(same_way, IsDirection(d, dir)));
  const auto eta1 = hn::Set(d, 1 / job.index);
  const auto inside =
      RefractAt(d, hit1, dir, eta1, hn::Set(d, (1 - 1 / job.index) * (1 + 1 / job.index)), sense);
  const auto entered = hn::And(hit1.ok, inside.ok);

  auto p2 = hit1.point;
  p2.z = hn::Add(p2.z, hn::Set(d, job.first.vertex_z - job.second.vertex_z));
  const auto hit2 = second.Intersect(p2, inside.direction);
  const auto eta2 = hn::Set(d, job.index);
  const auto after = RefractAt(d, hit2, inside.direction, eta2,
                               hn::Set(d, (1 - job.index) * (1 + job.index)), sense);
  const auto reached = hn::And(entered, hit2.ok);
  const auto ok = hn::And(reached, after.ok);

  StorePoints(d, ok, hit2.point, job.second.vertex_z, out.exit, i);
  StoreDirections(d, ok, after.direction, out.exit, i);
  // Total reflection at the first surface counts as reached: IfThenElse(reached, total, miss).
  const auto total_first = hn::AndNot(inside.ok, hit1.ok);
  StoreStatus(d, hn::Or(reached, total_first), ok, out.status + i);
  if (out.first != nullptr) {
    StorePoints(d, hit1.ok, hit1.point, job.first.vertex_z, *out.first, i);
    StoreDirections(d, hit1.ok, hit1.normal, *out.first, i);
  }
  if (out.inside != nullptr) {
    StorePoints(d, reached, hit2.point, job.second.vertex_z, *out.inside, i);
    StoreDirections(d, reached, inside.direction, *out.inside, i);
  }
  if (out.second != nullptr) StoreDirections(d, reached, hit2.normal, *out.second, i);
  if (out.first_reflectance != nullptr) {
    hn::StoreU(hn::IfThenElseZero(hit1.ok, Reflectance(d, hit1.cosine, inside.along, eta1)), d,
               out.first_reflectance + i);
  }
  if (out.second_reflectance != nullptr) {
    hn::StoreU(hn::IfThenElseZero(reached, Reflectance(d, hit2.cosine, after.along, eta2)), d,
               out.second_reflectance + i);
  }
}

// One register of rays inside the glass to one face.
template <class D, class T = hn::TFromD<D>>
LORGNETTE_KERNEL_INLINE void FaceOne(D d, const AnyFace<D>& face, const FaceJob<T>& job,
                                     const RayArrays<const T>& in, const FaceBatchOutput<T>& out,
                                     std::size_t i) {
  const auto dir = LoadDirections(d, in, i);
  auto p = LoadPoints(d, in, i);
  p.z = hn::Sub(p.z, hn::Set(d, job.face.vertex_z));
  auto hit = face.Intersect(p, dir);
  hit.ok = hn::And(hit.ok, hn::And(hn::Gt(hit.distance, hn::Zero(d)), IsDirection(d, dir)));
  const auto eta = hn::Set(d, job.index);
  const auto after = RefractAt(d, hit, dir, eta, hn::Set(d, (1 - job.index) * (1 + job.index)),
                               hn::Set(d, job.sense));
  const auto ok = hn::And(hit.ok, after.ok);
  StorePoints(d, hit.ok, hit.point, job.face.vertex_z, out.hit, i);
  StoreDirections(d, hit.ok, hit.normal, out.hit, i);
  StoreStatus(d, hit.ok, ok, out.status + i);
  if (out.refracted != nullptr) StoreDirections(d, ok, after.direction, *out.refracted, i);
  if (out.reflected != nullptr) {
    const auto mirrored = Along<D>(dir, hn::Mul(hn::Set(d, T(-2)), hit.cosine), hit.normal);
    StoreDirections(d, hit.ok, mirrored, *out.reflected, i);
  }
  if (out.reflectance != nullptr) {
    hn::StoreU(hn::IfThenElseZero(hit.ok, Reflectance(d, hit.cosine, after.along, eta)), d,
               out.reflectance + i);
  }
}

// Room for the ragged tail: a few padded arrays on the stack.
template <typename T>
struct TailRays {
  static constexpr std::size_t kLanes = HWY_MAX_BYTES / sizeof(T);
  HWY_ALIGN T values[6][kLanes];
  RayArrays<T> arrays{values[0], values[1], values[2], values[3], values[4], values[5]};

  // Copies m rays and fills the rest with the last of them.
  RayArrays<const T> Fill(const RayArrays<const T>& in, std::size_t i, std::size_t m) {
    const T* from[6] = {in.ox, in.oy, in.oz, in.dx, in.dy, in.dz};
    for (int f = 0; f < 6; ++f) {
      for (std::size_t k = 0; k < kLanes; ++k) values[f][k] = from[f][i + (k < m ? k : m - 1)];
    }
    return {values[0], values[1], values[2], values[3], values[4], values[5]};
  }
  void CopyTo(const RayArrays<T>& out, std::size_t i, std::size_t m, bool points = true) const {
    T* to[6] = {out.ox, out.oy, out.oz, out.dx, out.dy, out.dz};
    for (int f = points ? 0 : 3; f < 6; ++f) {
      for (std::size_t k = 0; k < m; ++k) to[f][i + k] = values[f][k];
    }
  }
};

template <typename T>
void CopyTail(const T* from, T* to, std::size_t m) {
  for (std::size_t k = 0; k < m; ++k) to[k] = from[k];
}

// The whole registers of the job; returns how many rays they hold. Called for the ragged tail too,
// rather than compiled twice.
template <class First, class Second, class D, class T = hn::TFromD<D>>
HWY_NOINLINE std::size_t TraceWhole(D d, const LensJob<T>& job) {
  const First first(d, job.first, job.sense);
  const Second second(d, job.second, job.sense);
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= job.n; i += lanes) TraceOne(d, first, second, job, job.in, job.out, i);
  return i;
}

template <class First, class Second, class D, class T = hn::TFromD<D>>
LORGNETTE_KERNEL_INLINE void TraceAll(D d, const LensJob<T>& job) {
  const std::size_t i = TraceWhole<First, Second>(d, job);
  const std::size_t m = job.n - i;
  if (m == 0) return;

  constexpr std::size_t kLanes = TailRays<T>::kLanes;
  TailRays<T> in, exit, first_hit, inside, second_hit;
  std::uint8_t status[kLanes];
  HWY_ALIGN T reflectance1[kLanes];
  HWY_ALIGN T reflectance2[kLanes];
  LensBatchOutput<T> out{exit.arrays, status};
  if (job.out.first != nullptr) out.first = &first_hit.arrays;
  if (job.out.inside != nullptr) out.inside = &inside.arrays;
  if (job.out.second != nullptr) out.second = &second_hit.arrays;
  if (job.out.first_reflectance != nullptr) out.first_reflectance = reflectance1;
  if (job.out.second_reflectance != nullptr) out.second_reflectance = reflectance2;
  LensJob<T> rest = job;
  rest.in = in.Fill(job.in, i, m);
  rest.n = hn::Lanes(d);
  rest.out = out;
  TraceWhole<First, Second>(d, rest);
  exit.CopyTo(job.out.exit, i, m);
  CopyTail(status, job.out.status + i, m);
  if (out.first != nullptr) first_hit.CopyTo(*job.out.first, i, m);
  if (out.inside != nullptr) inside.CopyTo(*job.out.inside, i, m);
  if (out.second != nullptr) second_hit.CopyTo(*job.out.second, i, m, false);
  if (out.first_reflectance != nullptr) {
    CopyTail(reflectance1, job.out.first_reflectance + i, m);
  }
  if (out.second_reflectance != nullptr) {
    CopyTail(reflectance2, job.out.second_reflectance + i, m);
  }
}

template <typename T>
LORGNETTE_KERNEL_INLINE void TraceLensOf(const LensJob<T>& job) {
  const hn::ScalableTag<T> d;
  using D = hn::ScalableTag<T>;
  using Sphere = SphereFace<D>;
  using Upright = GeneralFace<D, true>;
  using Any = AnyFace<D>;
  const auto upright = [](const FaceParams<T>& f) {
    return !f.tilted && (f.kind == FaceKind::kSphere || f.kind == FaceKind::kTorus);
  };
  if (!upright(job.first) || !upright(job.second)) return TraceAll<Any, Any>(d, job);
  if (job.first.kind == FaceKind::kTorus) return TraceAll<Upright, Upright>(d, job);
  if (job.second.kind == FaceKind::kTorus) return TraceAll<Sphere, Upright>(d, job);
  TraceAll<Sphere, Sphere>(d, job);
}

template <class D, class T = hn::TFromD<D>>
HWY_NOINLINE std::size_t FaceWhole(D d, const FaceJob<T>& job) {
  const AnyFace<D> face(d, job.face, job.sense);
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= job.n; i += lanes) FaceOne(d, face, job, job.in, job.out, i);
  return i;
}

template <typename T>
LORGNETTE_KERNEL_INLINE void TraceFaceOf(const FaceJob<T>& job) {
  const hn::ScalableTag<T> d;
  const std::size_t i = FaceWhole(d, job);
  const std::size_t m = job.n - i;
  if (m == 0) return;

  constexpr std::size_t kLanes = TailRays<T>::kLanes;
  TailRays<T> in, hit, refracted, reflected;
  std::uint8_t status[kLanes];
  HWY_ALIGN T reflectance[kLanes];
  FaceBatchOutput<T> out{hit.arrays, status};
  if (job.out.refracted != nullptr) out.refracted = &refracted.arrays;
  if (job.out.reflected != nullptr) out.reflected = &reflected.arrays;
  if (job.out.reflectance != nullptr) out.reflectance = reflectance;
  FaceJob<T> rest = job;
  rest.in = in.Fill(job.in, i, m);
  rest.n = hn::Lanes(d);
  rest.out = out;
  FaceWhole(d, rest);
  hit.CopyTo(job.out.hit, i, m);
  CopyTail(status, job.out.status + i, m);
  if (out.refracted != nullptr) refracted.CopyTo(*job.out.refracted, i, m, false);
  if (out.reflected != nullptr) reflected.CopyTo(*job.out.reflected, i, m, false);
  if (out.reflectance != nullptr) CopyTail(reflectance, job.out.reflectance + i, m);
}

void TraceLensFloat(const LensJob<float>& job) { TraceLensOf(job); }
void TraceLensDouble(const LensJob<double>& job) { TraceLensOf(job); }
void TraceFaceFloat(const FaceJob<float>& job) { TraceFaceOf(job); }
void TraceFaceDouble(const FaceJob<double>& job) { TraceFaceOf(job); }
const char* TargetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace lorgnette::kernel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lorgnette {
namespace kernel {

HWY_EXPORT(TraceLensFloat);
HWY_EXPORT(TraceLensDouble);
HWY_EXPORT(TraceFaceFloat);
HWY_EXPORT(TraceFaceDouble);
HWY_EXPORT(TargetName);

namespace {

// Sag along the corridor of a progressive surface as a Chebyshev series in 2 u - 1.
struct Corridor {
  std::array<double, kCorridorTerms> terms{};
  double far = 0, add = 0, start = 0, length = 0;  // of the surface that it belongs to
};
const Corridor& CorridorOf(const ProgressiveSurface& s) {
  // Batches come many to a lens: the last two surfaces are kept, a pair of lenses.
  thread_local std::array<Corridor, 2> kept;
  thread_local std::size_t oldest = 0;
  for (const Corridor& c : kept) {
    if (c.length == s.length() && c.far == s.curvature_far() && c.add == s.curvature_add() &&
        c.start == s.start()) {
      return c;
    }
  }
  Corridor& made = kept[oldest];
  oldest = 1 - oldest;
  made = {{}, s.curvature_far(), s.curvature_add(), s.start(), s.length()};
  constexpr double n = kCorridorTerms;
  for (std::size_t k = 0; k < kCorridorTerms; ++k) {
    const double x = std::cos(kPi * (double(k) + 0.5) / n);
    const auto jet = s.OwnJet(0, s.start() - s.length() * 0.5 * (1 + x));
    const double z = jet ? jet->z : 0;
    for (std::size_t i = 0; i < kCorridorTerms; ++i) {
      made.terms[i] += (i == 0 ? 1 : 2) / n * z * std::cos(kPi * double(i) * (double(k) + 0.5) / n);
    }
  }
  return made;
}

template <typename T>
void SetProgressive(const ProgressiveSurface& s, FaceParams<T>& f) {
  f.kind = FaceKind::kProgressive;
  f.c = static_cast<T>(s.curvature_far());
  f.add = static_cast<T>(s.curvature_add());
  f.start = static_cast<T>(s.start());
  f.length = static_cast<T>(s.length());
  const double end_sine =
      s.curvature_far() * (s.start() - s.length()) - s.curvature_add() * s.length() * 0.5;
  f.end_sine = static_cast<T>(end_sine);
  const auto end = s.OwnJet(0, s.start() - s.length());
  f.end_sag = static_cast<T>(end ? end->z : 0);
  const Corridor& corridor = CorridorOf(s);
  for (std::size_t i = 0; i < kCorridorTerms; ++i) {
    f.corridor[i] = static_cast<T>(corridor.terms[i]);
  }
}

double MeanCurvature(const Surface& surface) { return 0.5 * surface.VertexCurvature().trace(); }

// Coefficients of a grid as the kernel's numbers. The last two grids are kept, with what they
// belong to, so that an address cannot come to mean another grid.
template <typename T>
const T* CoefficientsOf(const std::shared_ptr<const SplineGrid>& grid) {
  if constexpr (std::is_same_v<T, double>) {
    return grid->coefficients.data();
  } else {
    struct Kept {
      std::shared_ptr<const SplineGrid> grid;
      Eigen::MatrixXf coefficients;
    };
    thread_local std::array<Kept, 2> kept;
    thread_local std::size_t oldest = 0;
    for (const Kept& k : kept) {
      if (k.grid == grid) return k.coefficients.data();
    }
    Kept& made = kept[oldest];
    oldest = 1 - oldest;
    made = {grid, grid->coefficients.cast<float>()};
    return made.coefficients.data();
  }
}

template <typename T>
void SetGrid(const Surface& surface, const GridSurface& s, FaceParams<T>& f) {
  const SplineGrid& grid = *s.grid;
  f.kind = FaceKind::kGrid;
  f.c = static_cast<T>(MeanCurvature(surface));
  f.base = static_cast<T>(grid.base_curvature);
  f.x0 = static_cast<T>(grid.x0);
  f.y0 = static_cast<T>(grid.y0);
  f.per_x = static_cast<T>(1 / grid.pitch_x);
  f.per_y = static_cast<T>(1 / grid.pitch_y);
  f.nx = static_cast<T>(grid.nx());
  f.ny = static_cast<T>(grid.ny());
  f.coefficients = CoefficientsOf<T>(s.grid);
}

template <typename T>
void SetAtoroid(const Surface& surface, const AtoroidSurface& s, FaceParams<T>& f) {
  f.kind = FaceKind::kAtoroid;
  f.c = static_cast<T>(MeanCurvature(surface));
  f.generator = static_cast<T>(s.curvature_generator);
  f.across = static_cast<T>(s.curvature_across);
  f.conic = static_cast<T>(1 + s.conic_generator);
  f.conic_across = static_cast<T>(1 + s.conic_across);
  f.even[0] = static_cast<T>(s.a4_generator);
}

// `rotation` turns the surface's own axes into the lens frame's.
template <typename T>
FaceParams<T> ParamsOf(const Surface& surface, double vertex_z, const Eigen::Matrix3d& rotation) {
  FaceParams<T> f;
  f.vertex_z = static_cast<T>(vertex_z);
  f.tilted = !rotation.isIdentity(0);
  double angle = kPi / 2;  // of `g`, from the own +x
  if (const auto* sphere = std::get_if<SphereSurface>(&surface.shape())) {
    f.c = static_cast<T>(sphere->curvature);
  } else if (const auto* torus = std::get_if<TorusSurface>(&surface.shape())) {
    const bool round = torus->curvature_generator == torus->curvature_across;
    f.kind = round ? FaceKind::kSphere : FaceKind::kTorus;
    f.c = static_cast<T>(torus->curvature_across);
    f.generator = static_cast<T>(torus->curvature_generator);
    f.delta = static_cast<T>(torus->curvature_generator - torus->curvature_across);
    angle = torus->generator_angle;
  } else if (const auto* conic = std::get_if<ConicSurface>(&surface.shape())) {
    f.kind = FaceKind::kConic;
    f.c = static_cast<T>(conic->curvature);
    f.conic = static_cast<T>(1 + conic->conic);
    for (std::size_t i = 0; i < f.even.size(); ++i) f.even[i] = static_cast<T>(conic->even[i]);
  } else if (const auto* progressive = std::get_if<ProgressiveSurface>(&surface.shape())) {
    SetProgressive(*progressive, f);
    angle += progressive->angle();
  } else if (const auto* atoroid = std::get_if<AtoroidSurface>(&surface.shape())) {
    SetAtoroid(surface, *atoroid, f);
    angle = atoroid->generator_angle;
  } else if (const auto* grid = std::get_if<GridSurface>(&surface.shape())) {
    SetGrid(surface, *grid, f);
  }
  const double co = std::cos(angle), si = std::sin(angle);
  const auto set = [](T& x, T& y, T& z, const Eigen::Vector3d& v) {
    x = static_cast<T>(v.x());
    y = static_cast<T>(v.y());
    z = static_cast<T>(v.z());
  };
  set(f.ax, f.ay, f.az, rotation.col(2));
  set(f.gx, f.gy, f.gz, rotation * Eigen::Vector3d(co, si, 0));
  set(f.ux, f.uy, f.uz, rotation * Eigen::Vector3d(si, -co, 0));
  return f;
}

template <typename T>
FaceParams<T> ParamsOf(const Lens& lens, LensFace face) {
  if (face == LensFace::kFront) return ParamsOf<T>(lens.front, 0, Eigen::Matrix3d::Identity());
  return ParamsOf<T>(lens.back, lens.center_thickness_mm, BackRotation(lens));
}

bool HasSimdForm(const Surface& surface) {
  return !std::holds_alternative<BifocalSurface>(surface.shape());
}

template <typename T>
void RunLens(const Lens& lens, double index, const RayArrays<const T>& in, std::size_t n,
             const LensBatchOutput<T>& out) {
  if (n == 0) return;
  if (!HasSimdForm(lens.front) || !HasSimdForm(lens.back)) {
    return TraceLensScalar(lens, index, in, n, out);
  }
  const bool forward = in.dz[0] > 0;
  LensJob<T> job;
  job.first = ParamsOf<T>(lens, forward ? LensFace::kFront : LensFace::kBack);
  job.second = ParamsOf<T>(lens, forward ? LensFace::kBack : LensFace::kFront);
  job.sense = forward ? T(1) : T(-1);
  job.index = static_cast<T>(index);
  job.in = in;
  job.n = n;
  job.out = out;
  if constexpr (std::is_same_v<T, float>) {
    HWY_DYNAMIC_DISPATCH(TraceLensFloat)(job);
  } else {
    HWY_DYNAMIC_DISPATCH(TraceLensDouble)(job);
  }
}

template <typename T>
void RunFace(const Lens& lens, LensFace face, double index, const RayArrays<const T>& in,
             std::size_t n, const FaceBatchOutput<T>& out) {
  if (n == 0) return;
  if (!HasSimdForm(face == LensFace::kFront ? lens.front : lens.back)) {
    return TraceFaceScalar(lens, face, index, in, n, out);
  }
  FaceJob<T> job;
  job.face = ParamsOf<T>(lens, face);
  job.sense = face == LensFace::kBack ? T(1) : T(-1);
  job.index = static_cast<T>(index);
  job.in = in;
  job.n = n;
  job.out = out;
  if constexpr (std::is_same_v<T, float>) {
    HWY_DYNAMIC_DISPATCH(TraceFaceFloat)(job);
  } else {
    HWY_DYNAMIC_DISPATCH(TraceFaceDouble)(job);
  }
}

}  // namespace
}  // namespace kernel

void TraceLensBatch(const Lens& lens, double index, const RayArrays<const float>& in, std::size_t n,
                    const LensBatchOutput<float>& out) {
  kernel::RunLens(lens, index, in, n, out);
}
void TraceLensBatch(const Lens& lens, double index, const RayArrays<const double>& in,
                    std::size_t n, const LensBatchOutput<double>& out) {
  kernel::RunLens(lens, index, in, n, out);
}
void TraceFaceBatch(const Lens& lens, LensFace face, double index, const RayArrays<const float>& in,
                    std::size_t n, const FaceBatchOutput<float>& out) {
  kernel::RunFace(lens, face, index, in, n, out);
}
void TraceFaceBatch(const Lens& lens, LensFace face, double index,
                    const RayArrays<const double>& in, std::size_t n,
                    const FaceBatchOutput<double>& out) {
  kernel::RunFace(lens, face, index, in, n, out);
}

const char* LensKernelTarget() { return HWY_DYNAMIC_DISPATCH(kernel::TargetName)(); }

}  // namespace lorgnette
#endif
