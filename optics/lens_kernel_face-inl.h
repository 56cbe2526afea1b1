// SPDX-License-Identifier: Apache-2.0
// Rays and one surface, a SIMD register of rays at a time; compiled for every instruction set.
//
// Sphere and torus are zero sets of
//   G = 2 a.p - c p.p - delta (y^2 + s(y)^2),   y = g.p,  s(y) the sag of the generator circle,
// (sphere: delta = 0) with N = grad G / 2 = a - c p - delta (y / w) g, w^2 = 1 - generator^2 y^2.
// The form has no radius in it and holds from plano to steep. Derivation: docs/measurement.md.

// Highway's own guard: this header is included again for every target.
#if defined(LORGNETTE_OPTICS_LENS_KERNEL_FACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LORGNETTE_OPTICS_LENS_KERNEL_FACE_INL_H_
#undef LORGNETTE_OPTICS_LENS_KERNEL_FACE_INL_H_
#else
#define LORGNETTE_OPTICS_LENS_KERNEL_FACE_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "optics/lens_kernel_job.h"

HWY_BEFORE_NAMESPACE();
namespace lorgnette::kernel {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
struct Vec3 {
  hn::Vec<D> x, y, z;
};

template <class D>
HWY_INLINE hn::Vec<D> Dot(const Vec3<D>& a, const Vec3<D>& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

// p + t d
template <class D>
HWY_INLINE Vec3<D> Along(const Vec3<D>& p, hn::Vec<D> t, const Vec3<D>& d) {
  return {hn::MulAdd(t, d.x, p.x), hn::MulAdd(t, d.y, p.y), hn::MulAdd(t, d.z, p.z)};
}

// Where rays meet a face, relative to its vertex. Lanes that are not ok hold anything.
template <class D>
struct FaceHit {
  hn::Mask<D> ok;
  hn::Vec<D> distance;
  Vec3<D> point, normal;
  hn::Vec<D> cosine;  // normal . direction; has the sign of the sense where ok
};

// No crossing of a lens lies farther than this from the point of a ray nearest the vertex, mm.
inline constexpr double kFarthest_mm = 1e5;

// The root of c t^2 - 2 b t + h = 0 for which b - c t has the sign of `sense` (+-1); `*root`
// receives that b - c t. `*ok` is false where there is none.
template <class D>
HWY_INLINE hn::Vec<D> StableRoot(D d, hn::Vec<D> c, hn::Vec<D> b, hn::Vec<D> h, hn::Vec<D> sense,
                                 hn::Vec<D>* root, hn::Mask<D>* ok) {
  using T = hn::TFromD<D>;
  const auto zero = hn::Zero(d);
  // b^2 - c h with one rounding (Kahan), since it cancels at grazing incidence.
  const auto ch = hn::Mul(c, h);
  const auto bb = hn::Mul(b, b);
  const auto disc = hn::Add(hn::MulSub(b, b, ch), hn::NegMulAdd(c, h, ch));
  const auto rounding =
      hn::Mul(hn::Set(d, T(-2) * std::numeric_limits<T>::epsilon()), hn::Add(bb, hn::Abs(ch)));
  *ok = hn::Ge(disc, rounding);
  *root = hn::Mul(sense, hn::Sqrt(hn::Max(disc, zero)));
  auto t = hn::Div(h, hn::Add(b, *root));
  // Seen from the start the surface curls away: the wanted root is the other one. Rare.
  const auto other = hn::Lt(hn::Mul(b, sense), zero);
  if (HWY_UNLIKELY(!hn::AllFalse(d, other))) {
    t = hn::IfThenElse(other, hn::Div(hn::Sub(b, *root), c), t);
  }
  return t;
}

// A sphere whose axis is that of the lens.
template <class D>
struct SphereFace {
  D d;
  hn::Vec<D> c, sense;

  template <class Params>
  HWY_INLINE SphereFace(D tag, const Params& params, hn::TFromD<D> sign)
      : d(tag), c(hn::Set(tag, params.c)), sense(hn::Set(tag, sign)) {}

  HWY_INLINE FaceHit<D> Intersect(const Vec3<D>& p, const Vec3<D>& dir) const {
    const auto b = hn::NegMulAdd(c, Dot<D>(p, dir), dir.z);
    const auto h = hn::MulSub(c, Dot<D>(p, p), hn::Add(p.z, p.z));
    FaceHit<D> hit;
    hit.distance = StableRoot(d, c, b, h, sense, &hit.cosine, &hit.ok);
    hit.point = Along<D>(p, hit.distance, dir);
    const auto minus_c = hn::Neg(c);
    hit.normal = {hn::Mul(minus_c, hit.point.x), hn::Mul(minus_c, hit.point.y),
                  hn::NegMulAdd(c, hit.point.z, hn::Set(d, 1))};
    const auto near = hn::Lt(hn::Abs(hit.distance), hn::Set(d, kFarthest_mm));
    hit.ok = hn::And(hit.ok, hn::And(near, hn::Gt(hit.normal.z, hn::Zero(d))));
    return hit;
  }
};

// Sphere or torus with any axis.
template <class D>
struct GeneralFace {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  D d;
  V c, generator2, generator, delta, sense;
  Vec3<D> a, g;
  bool torus;

  HWY_INLINE GeneralFace(D tag, const FaceParams<T>& f, T sign)
      : d(tag),
        c(hn::Set(tag, f.c)),
        generator2(hn::Set(tag, f.generator * f.generator)),
        generator(hn::Set(tag, f.generator)),
        delta(hn::Set(tag, f.delta)),
        sense(hn::Set(tag, sign)),
        a{hn::Set(tag, f.ax), hn::Set(tag, f.ay), hn::Set(tag, f.az)},
        g{hn::Set(tag, f.gx), hn::Set(tag, f.gy), hn::Set(tag, f.gz)},
        torus(f.torus) {}

  // Half of G, N, and what bounds the sheet, at one point of the line.
  struct Jet {
    V value;
    Vec3<D> n;
    V w2, scale;  // 1 - generator^2 y^2 and 1 - c s: both positive on the sheet
  };
  HWY_INLINE Jet JetAt(const Vec3<D>& p) const {
    const V one = hn::Set(d, 1), half = hn::Set(d, T(0.5));
    const V y = Dot<D>(g, p), y2 = hn::Mul(y, y);
    Jet jet;
    jet.w2 = hn::NegMulAdd(generator2, y2, one);
    // Off the domain the slope of its last zone continues, so that Newton can come back.
    const V w = hn::Sqrt(hn::Max(jet.w2, hn::Set(d, T(1e-4))));
    const V w1 = hn::Add(one, w);
    const V inverse = hn::Div(one, hn::Mul(w, w1));
    const V sag = hn::Mul(hn::Mul(generator, y2), hn::Mul(w, inverse));
    const V y_over_w = hn::Mul(y, hn::Mul(w1, inverse));
    const V curved = hn::MulAdd(c, Dot<D>(p, p), hn::Mul(delta, hn::MulAdd(sag, sag, y2)));
    jet.value = hn::NegMulAdd(half, curved, Dot<D>(a, p));
    const V k = hn::Mul(delta, y_over_w);
    jet.n = {hn::NegMulAdd(c, p.x, hn::NegMulAdd(k, g.x, a.x)),
             hn::NegMulAdd(c, p.y, hn::NegMulAdd(k, g.y, a.y)),
             hn::NegMulAdd(c, p.z, hn::NegMulAdd(k, g.z, a.z))};
    jet.scale = hn::NegMulAdd(c, sag, one);
    return jet;
  }

  HWY_INLINE FaceHit<D> Intersect(const Vec3<D>& p, const Vec3<D>& dir) const {
    const V zero = hn::Zero(d), pa = Dot<D>(a, p), da = Dot<D>(a, dir);
    FaceHit<D> hit;
    if (!torus) {
      const V b = hn::NegMulAdd(c, Dot<D>(p, dir), da);
      const V h = hn::MulSub(c, Dot<D>(p, p), hn::Add(pa, pa));
      hit.distance = StableRoot(d, c, b, h, sense, &hit.cosine, &hit.ok);
      hit.point = Along<D>(p, hit.distance, dir);
      hit.normal = {hn::NegMulAdd(c, hit.point.x, a.x), hn::NegMulAdd(c, hit.point.y, a.y),
                    hn::NegMulAdd(c, hit.point.z, a.z)};
    } else {
      IntersectTorus(p, dir, pa, da, &hit);
    }
    const auto near = hn::Lt(hn::Abs(hit.distance), hn::Set(d, T(kFarthest_mm)));
    hit.ok = hn::And(hit.ok, hn::And(near, hn::Gt(Dot<D>(a, hit.normal), zero)));
    return hit;
  }

  HWY_INLINE void IntersectTorus(const Vec3<D>& p, const Vec3<D>& dir, V pa, V da,
                                 FaceHit<D>* hit) const {
    constexpr bool kDouble = sizeof(T) == 8;
    constexpr int kSteps = kDouble ? 2 : 1;
    constexpr int kMoreSteps = 12;
    constexpr T kResidual_mm = kDouble ? T(2e-13) : T(2e-5);
    const V zero = hn::Zero(d), one = hn::Set(d, 1);

    // Start: the quadric that G becomes when s^2 is frozen near the ray's start.
    const V y0 = Dot<D>(g, p), yd = Dot<D>(g, dir);
    const V y2 = hn::Mul(y0, y0);
    const V sag = hn::Mul(hn::Mul(hn::Set(d, T(0.5)), generator), y2);
    const V quadratic = hn::MulAdd(delta, hn::Mul(yd, yd), c);
    const V b = hn::NegMulAdd(c, Dot<D>(p, dir), hn::NegMulAdd(delta, hn::Mul(y0, yd), da));
    const V h = hn::MulSub(delta, hn::MulAdd(sag, sag, y2),
                           hn::NegMulAdd(c, Dot<D>(p, p), hn::Add(pa, pa)));
    V root;
    hn::Mask<D> started;
    V t = StableRoot(d, quadratic, b, h, sense, &root, &started);
    // Where the quadric is missed the torus may still be hit: start at the vertex plane's foot.
    t = hn::IfThenElse(hn::Lt(hn::Abs(t), hn::Set(d, T(kFarthest_mm))), t, zero);

    Jet jet;
    for (int i = 0; i < kSteps; ++i) {
      jet = JetAt(Along<D>(p, t, dir));
      t = hn::Sub(t, hn::Div(jet.value, Dot<D>(jet.n, dir)));
    }
    const auto tolerance = hn::Set(d, kResidual_mm);
    hn::Mask<D> converged;
    for (int i = 0;; ++i) {
      hit->point = Along<D>(p, t, dir);
      jet = JetAt(hit->point);
      converged = hn::Le(hn::Abs(jet.value), tolerance);
      if (HWY_LIKELY(hn::AllTrue(d, converged)) || i == kMoreSteps) break;
      t = hn::Sub(t,
                  hn::IfThenElseZero(hn::Not(converged), hn::Div(jet.value, Dot<D>(jet.n, dir))));
    }
    const V inverse = hn::Div(one, hn::Sqrt(Dot<D>(jet.n, jet.n)));
    hit->normal = {hn::Mul(jet.n.x, inverse), hn::Mul(jet.n.y, inverse), hn::Mul(jet.n.z, inverse)};
    hit->cosine = Dot<D>(hit->normal, dir);
    hit->distance = t;
    const auto on_sheet = hn::And(hn::Gt(jet.w2, zero), hn::Gt(jet.scale, zero));
    const auto with_sense = hn::Gt(hn::Mul(hit->cosine, sense), zero);
    hit->ok = hn::And(converged, hn::And(on_sheet, with_sense));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace lorgnette::kernel
HWY_AFTER_NAMESPACE();

#endif
