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
LORGNETTE_KERNEL_INLINE hn::Vec<D> Dot(const Vec3<D>& a, const Vec3<D>& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

// p + t d
template <class D>
LORGNETTE_KERNEL_INLINE Vec3<D> Along(const Vec3<D>& p, hn::Vec<D> t, const Vec3<D>& d) {
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

// Square root of x >= 0 to about a unit in the last place. In float from the machine's reciprocal
// root and one Newton step, which takes half the time of the exact instruction.
template <class D>
LORGNETTE_KERNEL_INLINE hn::Vec<D> QuickSqrt(D d, hn::Vec<D> x) {
  using T = hn::TFromD<D>;
  if constexpr (sizeof(T) == 8) {
    return hn::Sqrt(x);
  } else {
    const auto y =
        hn::ApproximateReciprocalSqrt(hn::Max(x, hn::Set(d, std::numeric_limits<T>::min())));
    const auto s = hn::Mul(x, y);
    return hn::MulAdd(hn::Mul(hn::Set(d, T(0.5)), y), hn::NegMulAdd(s, s, x), s);
  }
}

// The root of c t^2 - 2 b t + h = 0 for which b - c t has the sign of `sense` (+-1); `*root`
// receives that b - c t. `*ok` is false where there is none.
template <class D>
LORGNETTE_KERNEL_INLINE hn::Vec<D> StableRoot(D d, hn::Vec<D> c, hn::Vec<D> b, hn::Vec<D> h,
                                              hn::Vec<D> sense, hn::Vec<D>* root, hn::Mask<D>* ok) {
  using T = hn::TFromD<D>;
  const auto zero = hn::Zero(d);
  // b^2 - c h with one rounding (Kahan), since it cancels at grazing incidence.
  const auto ch = hn::Mul(c, h);
  const auto bb = hn::Mul(b, b);
  const auto disc = hn::Add(hn::MulSub(b, b, ch), hn::NegMulAdd(c, h, ch));
  const auto rounding =
      hn::Mul(hn::Set(d, T(-2) * std::numeric_limits<T>::epsilon()), hn::Add(bb, hn::Abs(ch)));
  *ok = hn::Ge(disc, rounding);
  *root = hn::Mul(sense, QuickSqrt(d, hn::Max(disc, zero)));
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
  LORGNETTE_KERNEL_INLINE SphereFace(D tag, const Params& params, hn::TFromD<D> sign)
      : d(tag), c(hn::Set(tag, params.c)), sense(hn::Set(tag, sign)) {}

  LORGNETTE_KERNEL_INLINE FaceHit<D> Intersect(const Vec3<D>& p, const Vec3<D>& dir) const {
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

// Sphere or torus. kUpright: its axis is that of the lens (no ground prism).
template <class D, bool kUpright>
struct GeneralFace {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  D d;
  V c, generator2, generator, delta, sense;
  Vec3<D> a, g;
  bool torus;

  LORGNETTE_KERNEL_INLINE GeneralFace(D tag, const FaceParams<T>& f, T sign)
      : d(tag),
        c(hn::Set(tag, f.c)),
        generator2(hn::Set(tag, f.generator * f.generator)),
        generator(hn::Set(tag, f.generator)),
        delta(hn::Set(tag, f.delta)),
        sense(hn::Set(tag, sign)),
        a{hn::Set(tag, f.ax), hn::Set(tag, f.ay), hn::Set(tag, f.az)},
        g{hn::Set(tag, f.gx), hn::Set(tag, f.gy), hn::Set(tag, f.gz)},
        torus(f.kind == FaceKind::kTorus) {}

  LORGNETTE_KERNEL_INLINE V AxisDot(const Vec3<D>& v) const {
    return kUpright ? v.z : Dot<D>(a, v);
  }
  LORGNETTE_KERNEL_INLINE V GeneratorDot(const Vec3<D>& v) const {
    return kUpright ? hn::MulAdd(g.x, v.x, hn::Mul(g.y, v.y)) : Dot<D>(g, v);
  }

  LORGNETTE_KERNEL_INLINE FaceHit<D> Intersect(const Vec3<D>& p, const Vec3<D>& dir) const {
    FaceHit<D> hit = torus ? IntersectTorus(p, dir) : IntersectSphere(p, dir);
    const auto near = hn::Lt(hn::Abs(hit.distance), hn::Set(d, T(kFarthest_mm)));
    hit.ok = hn::And(hit.ok, hn::And(near, hn::Gt(AxisDot(hit.normal), hn::Zero(d))));
    return hit;
  }

 private:
  LORGNETTE_KERNEL_INLINE FaceHit<D> IntersectSphere(const Vec3<D>& p, const Vec3<D>& dir) const {
    const V pa = AxisDot(p);
    const V b = hn::NegMulAdd(c, Dot<D>(p, dir), AxisDot(dir));
    const V h = hn::MulSub(c, Dot<D>(p, p), hn::Add(pa, pa));
    FaceHit<D> hit;
    hit.distance = StableRoot(d, c, b, h, sense, &hit.cosine, &hit.ok);
    hit.point = Along<D>(p, hit.distance, dir);
    hit.normal = NormalAt(hit.point, hn::Zero(d));
    return hit;
  }

  // What the generator circle gives at one point.
  struct Circle {
    V y, y2;
    V w2;       // 1 - generator^2 y^2: positive on the sheet
    V inverse;  // 1 / w
    V half;     // 1 / (1 + w)
    V sag;
  };
  // By square root and division. Off the domain the slope of its last zone continues, so that
  // Newton can come back.
  LORGNETTE_KERNEL_INLINE Circle CircleAt(const Vec3<D>& p) const {
    const V one = hn::Set(d, 1);
    Circle s;
    s.y = GeneratorDot(p);
    s.y2 = hn::Mul(s.y, s.y);
    s.w2 = hn::NegMulAdd(generator2, s.y2, one);
    const V w = hn::Sqrt(hn::Max(s.w2, hn::Set(d, T(1e-4))));
    const V w1 = hn::Add(one, w);
    const V both = hn::Div(one, hn::Mul(w, w1));
    s.inverse = hn::Mul(w1, both);
    s.half = hn::Mul(w, both);
    s.sag = hn::Mul(hn::Mul(generator, s.y2), s.half);
    return s;
  }
  // The same from a neighbour's by one cubic iteration for each reciprocal. `defect` receives
  // 1 - w^2 r^2 of the neighbour's r: the error left is 5/16 of its cube.
  LORGNETTE_KERNEL_INLINE Circle CircleNear(const Circle& neighbour, const Vec3<D>& p,
                                            V* defect) const {
    const V one = hn::Set(d, 1);
    Circle s;
    s.y = GeneratorDot(p);
    s.y2 = hn::Mul(s.y, s.y);
    s.w2 = hn::NegMulAdd(generator2, s.y2, one);
    const V r = neighbour.inverse;
    *defect = hn::NegMulAdd(s.w2, hn::Mul(r, r), one);
    s.inverse = hn::MulAdd(hn::Mul(r, *defect),
                           hn::MulAdd(*defect, hn::Set(d, T(0.375)), hn::Set(d, T(0.5))), r);
    const V w1 = hn::MulAdd(s.w2, s.inverse, one);
    const V gap = hn::NegMulAdd(w1, neighbour.half, one);
    s.half = hn::MulAdd(hn::Mul(neighbour.half, gap), hn::Add(one, gap), neighbour.half);
    s.sag = hn::Mul(hn::Mul(generator, s.y2), s.half);
    return s;
  }
  // G / 2.
  LORGNETTE_KERNEL_INLINE V ValueAt(const Vec3<D>& p, const Circle& s) const {
    const V curved = hn::MulAdd(c, Dot<D>(p, p), hn::Mul(delta, hn::MulAdd(s.sag, s.sag, s.y2)));
    return hn::NegMulAdd(hn::Set(d, T(0.5)), curved, AxisDot(p));
  }
  // N; k = delta y / w.
  LORGNETTE_KERNEL_INLINE Vec3<D> NormalAt(const Vec3<D>& p, V k) const {
    if constexpr (kUpright) {
      return {hn::NegMulAdd(c, p.x, hn::Neg(hn::Mul(k, g.x))),
              hn::NegMulAdd(c, p.y, hn::Neg(hn::Mul(k, g.y))),
              hn::NegMulAdd(c, p.z, hn::Set(d, 1))};
    } else {
      return {hn::NegMulAdd(c, p.x, hn::NegMulAdd(k, g.x, a.x)),
              hn::NegMulAdd(c, p.y, hn::NegMulAdd(k, g.y, a.y)),
              hn::NegMulAdd(c, p.z, hn::NegMulAdd(k, g.z, a.z))};
    }
  }
  LORGNETTE_KERNEL_INLINE Vec3<D> NormalAt(const Vec3<D>& p, const Circle& s) const {
    return NormalAt(p, hn::Mul(hn::Mul(delta, s.y), s.inverse));
  }

  static constexpr bool kDouble = sizeof(T) == 8;
  static constexpr T kResidual_mm = kDouble ? T(2e-13) : T(2e-5);

  LORGNETTE_KERNEL_INLINE FaceHit<D> IntersectTorus(const Vec3<D>& p, const Vec3<D>& dir) const {
    // The last step of the fast path leaves an error of its square over a radius, and of the cube
    // of the circle's defect; lanes above these go the slow way.
    constexpr T kLastStep_mm = kDouble ? T(1e-6) : T(5e-3);
    constexpr T kLastDefect = kDouble ? T(5e-6) : T(5e-3);
    const V zero = hn::Zero(d), one = hn::Set(d, 1), two = hn::Set(d, 2);

    // Start: the quadric that G becomes when the generator's sag is frozen where the ray starts.
    const V yd = GeneratorDot(dir), pa = AxisDot(p);
    Circle circle = CircleAt(p);
    const V parabola = hn::Mul(hn::Mul(hn::Set(d, T(0.5)), generator), circle.y2);
    const V sag = hn::MulAdd(parabola, hn::Mul(hn::Set(d, T(0.25)), hn::Mul(generator2, circle.y2)),
                             parabola);
    const V quadratic = hn::MulAdd(delta, hn::Mul(yd, yd), c);
    const V b =
        hn::NegMulAdd(c, Dot<D>(p, dir), hn::NegMulAdd(delta, hn::Mul(circle.y, yd), AxisDot(dir)));
    const V h = hn::MulSub(delta, hn::MulAdd(sag, sag, circle.y2),
                           hn::NegMulAdd(c, Dot<D>(p, p), hn::Add(pa, pa)));
    V root, defect;
    M unused;
    V t = StableRoot(d, quadratic, b, h, sense, &root, &unused);

    // Newton; its slope's reciprocal by a Newton step from the quadric's.
    auto point = Along<D>(p, t, dir);
    circle = CircleNear(circle, point, &defect);
    auto n = NormalAt(point, circle);
    V slope = hn::Div(one, root);
    slope = hn::Mul(slope, hn::NegMulAdd(Dot<D>(n, dir), slope, two));
    V step = hn::Mul(ValueAt(point, circle), slope);
    if constexpr (kDouble) {
      t = hn::Sub(t, step);
      point = Along<D>(p, t, dir);
      circle = CircleNear(circle, point, &defect);
      n = NormalAt(point, circle);
      slope = hn::Mul(slope, hn::NegMulAdd(Dot<D>(n, dir), slope, two));
      step = hn::Mul(ValueAt(point, circle), slope);
    }
    const M fast = hn::And(hn::Le(hn::Abs(step), hn::Set(d, kLastStep_mm)),
                           hn::Le(hn::Abs(defect), hn::Set(d, kLastDefect)));
    if (HWY_UNLIKELY(!hn::AllTrue(d, fast))) return IntersectTorusSlowly(p, dir, t);

    FaceHit<D> hit;
    hit.distance = hn::Sub(t, step);
    const V back = hn::Neg(step);
    hit.point = Along<D>(point, back, dir);
    // N is carried over the last step by its derivative.
    const V bend = hn::Mul(hn::Mul(delta, yd),
                           hn::Mul(circle.inverse, hn::Mul(circle.inverse, circle.inverse)));
    const V kc = hn::Mul(step, c), kg = hn::Mul(step, bend);
    n = Along<D>(n, kc, dir);
    if constexpr (kUpright) {
      n.x = hn::MulAdd(kg, g.x, n.x);
      n.y = hn::MulAdd(kg, g.y, n.y);
    } else {
      n = Along<D>(n, kg, g);
    }
    const V scale = hn::NegMulAdd(c, circle.sag, one);
    Normalize(n, circle, scale, dir, &hit);
    hit.ok = hn::And(hn::Gt(scale, zero), hn::Gt(hn::Mul(hit.cosine, sense), zero));
    return hit;
  }

  // Unit normal and cosine. On the torus |N| = (1 - c s) / w; a Newton step takes out the rest.
  LORGNETTE_KERNEL_INLINE void Normalize(const Vec3<D>& n, const Circle& circle, V scale,
                                         const Vec3<D>& dir, FaceHit<D>* hit) const {
    V k = hn::Div(hn::Mul(circle.w2, circle.inverse), scale);
    k = hn::Mul(k, hn::NegMulAdd(hn::Mul(hn::Set(d, T(0.5)), Dot<D>(n, n)), hn::Mul(k, k),
                                 hn::Set(d, T(1.5))));
    hit->normal = {hn::Mul(n.x, k), hn::Mul(n.y, k), hn::Mul(n.z, k)};
    hit->cosine = Dot<D>(hit->normal, dir);
  }

  // Newton from `t` in every lane until it settles.
  HWY_NOINLINE FaceHit<D> IntersectTorusSlowly(const Vec3<D>& p, const Vec3<D>& dir, V t) const {
    constexpr int kMaxSteps = 16;
    const V zero = hn::Zero(d);
    // A start that is no number at all: begin where the ray is.
    t = hn::IfThenElse(hn::Lt(hn::Abs(t), hn::Set(d, T(kFarthest_mm))), t, zero);
    FaceHit<D> hit;
    Circle circle;
    Vec3<D> n;
    M converged;
    for (int i = 0;; ++i) {
      hit.point = Along<D>(p, t, dir);
      circle = CircleAt(hit.point);
      n = NormalAt(hit.point, circle);
      const V value = ValueAt(hit.point, circle);
      converged = hn::Le(hn::Abs(value), hn::Set(d, kResidual_mm));
      if (hn::AllTrue(d, converged) || i == kMaxSteps) break;
      // Lanes that have settled move by their last rounding only.
      t = hn::Sub(t, hn::Div(value, Dot<D>(n, dir)));
    }
    hit.distance = t;
    const V scale = hn::NegMulAdd(c, circle.sag, hn::Set(d, 1));
    Normalize(n, circle, scale, dir, &hit);
    const M on_sheet = hn::And(hn::Gt(circle.w2, zero), hn::Gt(scale, zero));
    hit.ok = hn::And(converged, hn::And(on_sheet, hn::Gt(hn::Mul(hit.cosine, sense), zero)));
    return hit;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace lorgnette::kernel
HWY_AFTER_NAMESPACE();

#endif
