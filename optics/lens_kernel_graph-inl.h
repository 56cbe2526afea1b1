// SPDX-License-Identifier: Apache-2.0
// Rays and a surface given as a graph z = sag(u, v) with its gradient: conics with even terms, the
// progressive surface, atoroids and spline grids. Newton from the vertex sphere; compiled for every
// instruction set.

// Highway's own guard: this header is included again for every target.
#if defined(LORGNETTE_OPTICS_LENS_KERNEL_GRAPH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LORGNETTE_OPTICS_LENS_KERNEL_GRAPH_INL_H_
#undef LORGNETTE_OPTICS_LENS_KERNEL_GRAPH_INL_H_
#else
#define LORGNETTE_OPTICS_LENS_KERNEL_GRAPH_INL_H_
#endif

#include <hwy/highway.h>

#include "optics/lens_kernel_face-inl.h"
#include "optics/lens_kernel_job.h"

HWY_BEFORE_NAMESPACE();
namespace lorgnette::kernel {
namespace HWY_NAMESPACE {

// Sag and gradient in the surface's own axes; `room` is positive on the sheet.
template <class D>
struct GraphJet {
  hn::Vec<D> z, zu, zv, room;
};

// Square roots off the domain are taken of this, so that Newton can come back.
inline constexpr double kLeastSquaredCosine = 1e-4;

template <class D>
LORGNETTE_KERNEL_INLINE hn::Vec<D> RootOf(D d, hn::Vec<D> squared) {
  return hn::Sqrt(hn::Max(squared, hn::Set(d, hn::TFromD<D>(kLeastSquaredCosine))));
}

template <class D, class T = hn::TFromD<D>>
LORGNETTE_KERNEL_INLINE GraphJet<D> ConicJet(D d, const FaceParams<T>& f, hn::Vec<D> u,
                                             hn::Vec<D> v) {
  const auto one = hn::Set(d, 1), c = hn::Set(d, f.c);
  const auto r2 = hn::MulAdd(u, u, hn::Mul(v, v));
  GraphJet<D> jet;
  jet.room = hn::NegMulAdd(hn::Set(d, f.conic * f.c * f.c), r2, one);
  const auto e = RootOf(d, jet.room);
  const auto even = [&](std::size_t i) { return hn::Set(d, f.even[i]); };
  const auto even_slope = [&](std::size_t i) { return hn::Set(d, T(i + 2) * f.even[i]); };
  const auto tail =
      hn::MulAdd(r2, hn::MulAdd(r2, hn::MulAdd(r2, even(3), even(2)), even(1)), even(0));
  const auto tail_slope =
      hn::MulAdd(r2, hn::MulAdd(r2, hn::MulAdd(r2, even_slope(3), even_slope(2)), even_slope(1)),
                 even_slope(0));
  const auto inverse = hn::Div(one, hn::Mul(e, hn::Add(one, e)));
  const auto conic = hn::Mul(hn::Mul(c, r2), hn::Mul(e, inverse));
  jet.z = hn::MulAdd(hn::Mul(r2, r2), tail, conic);
  // dz / d(r^2), twice: the gradient is this times (u, v).
  const auto slope =
      hn::MulAdd(hn::Mul(c, hn::Add(one, e)), inverse, hn::Mul(hn::Add(r2, r2), tail_slope));
  jet.zu = hn::Mul(slope, u);
  jet.zv = hn::Mul(slope, v);
  return jet;
}

// The umbilic's slope sine phi(v), its curvature and that one's derivative; see ProgressiveSurface.
template <class D, class T = hn::TFromD<D>>
LORGNETTE_KERNEL_INLINE GraphJet<D> ProgressiveJet(D d, const FaceParams<T>& f, hn::Vec<D> u,
                                                   hn::Vec<D> v) {
  const auto zero = hn::Zero(d), one = hn::Set(d, 1), half = hn::Set(d, T(0.5));
  const auto far = hn::Set(d, f.c), add = hn::Set(d, f.add);
  const auto raw = hn::Mul(hn::Sub(hn::Set(d, f.start), v), hn::Set(d, 1 / f.length));
  const auto s = hn::Min(hn::Max(raw, zero), one);
  const auto s2 = hn::Mul(s, s);
  const auto step = hn::Mul(
      hn::Mul(s2, s),
      hn::MulAdd(s, hn::MulAdd(s, hn::Set(d, T(6)), hn::Set(d, T(-15))), hn::Set(d, T(10))));
  const auto rest = hn::Mul(s, hn::Sub(one, s));
  const auto step1 = hn::Mul(hn::Set(d, T(30)), hn::Mul(rest, rest));
  const auto integral =
      hn::MulAdd(hn::Mul(s2, s2), hn::MulAdd(s, hn::Sub(s, hn::Set(d, T(3))), hn::Set(d, T(2.5))),
                 hn::Max(hn::Sub(raw, one), zero));
  const auto phi = hn::MulSub(far, v, hn::Mul(hn::Set(d, f.add * f.length), integral));
  const auto curvature = hn::MulAdd(add, step, far);
  const auto curvature1 = hn::Mul(hn::Set(d, -f.add / f.length), step1);

  const auto w2 = hn::NegMulAdd(phi, phi, one);
  const auto w = RootOf(d, w2);
  const auto inverse_w = hn::Div(one, w);

  // Sag along the umbilic: an arc from the vertex above the corridor, from its end below; a table
  // within. On an arc of curvature k the rise is (v - v0) (phi + phi0) / (w + w0).
  const auto below = hn::Ge(raw, one);
  const auto phi0 = hn::IfThenElse(below, hn::Set(d, f.end_sine), zero);
  const auto w0 =
      hn::IfThenElse(below, hn::Sqrt(hn::Set(d, (1 - f.end_sine) * (1 + f.end_sine))), one);
  const auto v0 = hn::IfThenElse(below, hn::Set(d, f.start - f.length), zero);
  const auto rise = hn::Div(hn::Mul(hn::Sub(v, v0), hn::Add(phi, phi0)), hn::Add(w, w0));
  auto g = hn::Add(rise, hn::IfThenElseZero(below, hn::Set(d, f.end_sag)));
  const auto within = hn::And(hn::Gt(raw, zero), hn::Lt(raw, one));
  if (!hn::AllFalse(d, within)) {
    // Clenshaw's recurrence in x = 2 s - 1.
    const auto x2 = hn::Mul(hn::Set(d, T(2)), hn::MulSub(hn::Set(d, T(2)), s, one));
    auto b1 = zero, b2 = zero;
    for (std::size_t i = kCorridorTerms - 1; i > 0; --i) {
      const auto b = hn::Add(hn::MulSub(x2, b1, b2), hn::Set(d, f.corridor[i]));
      b2 = b1;
      b1 = b;
    }
    const auto table = hn::Add(hn::MulSub(hn::Mul(half, x2), b1, b2), hn::Set(d, f.corridor[0]));
    g = hn::IfThenElse(within, table, g);
  }

  // Circular sections across: z = g + k u^2 / (1 + e), k = curvature / w.
  const auto k = hn::Mul(curvature, inverse_w);
  const auto k1 =
      hn::Mul(inverse_w, hn::MulAdd(hn::Mul(curvature, curvature),
                                    hn::Mul(phi, hn::Mul(inverse_w, inverse_w)), curvature1));
  const auto ku = hn::Mul(k, u), u2 = hn::Mul(u, u);
  const auto e2 = hn::NegMulAdd(ku, ku, one);
  const auto e = RootOf(d, e2);
  const auto inverse = hn::Div(one, hn::Mul(e, hn::Add(one, e)));
  GraphJet<D> jet;
  jet.room = hn::Min(w2, e2);
  jet.z = hn::MulAdd(hn::Mul(k, u2), hn::Mul(e, inverse), g);
  jet.zu = hn::Mul(ku, hn::Mul(hn::Add(one, e), inverse));
  jet.zv = hn::MulAdd(k1, hn::Mul(u2, inverse), hn::Mul(phi, inverse_w));
  return jet;
}

// Atoroid: a conic with a v^4 term, swept along conics across; see AtoroidSurface.
template <class D, class T = hn::TFromD<D>>
LORGNETTE_KERNEL_INLINE GraphJet<D> AtoroidJet(D d, const FaceParams<T>& f, hn::Vec<D> u,
                                               hn::Vec<D> v) {
  const auto one = hn::Set(d, 1), c = hn::Set(d, f.generator), a4 = hn::Set(d, f.even[0]);
  const auto v2 = hn::Mul(v, v), u2 = hn::Mul(u, u);
  const auto room_v = hn::NegMulAdd(hn::Set(d, f.conic * f.generator * f.generator), v2, one);
  const auto e = RootOf(d, room_v);
  const auto g = hn::MulAdd(hn::Mul(a4, v2), v2, hn::Div(hn::Mul(c, v2), hn::Add(one, e)));
  const auto g1 = hn::Mul(v, hn::MulAdd(hn::Mul(hn::Set(d, T(4)), a4), v2, hn::Div(c, e)));
  const auto scale = hn::NegMulAdd(hn::Set(d, f.across), g, one);
  const auto k = hn::Div(hn::Set(d, f.across), hn::Max(scale, hn::Set(d, T(kLeastSquaredCosine))));
  const auto k1 = hn::Mul(hn::Mul(k, k), g1);
  const auto room_u = hn::NegMulAdd(hn::Mul(hn::Set(d, f.conic_across), hn::Mul(k, k)), u2, one);
  const auto eu = RootOf(d, room_u);
  const auto inverse = hn::Div(one, hn::Mul(eu, hn::Add(one, eu)));
  GraphJet<D> jet;
  jet.room = hn::Min(hn::Min(room_v, room_u), scale);
  jet.z = hn::MulAdd(hn::Mul(k, u2), hn::Mul(eu, inverse), g);
  jet.zu = hn::Mul(hn::Mul(k, u), hn::Mul(hn::Add(one, eu), inverse));
  jet.zv = hn::MulAdd(k1, hn::Mul(u2, inverse), g1);
  return jet;
}

// The four cubic B-splines over a cell and their slopes.
template <class D>
struct SplineBasis {
  hn::Vec<D> b[4], b1[4];

  LORGNETTE_KERNEL_INLINE SplineBasis(D d, hn::Vec<D> u) {
    using T = hn::TFromD<D>;
    const auto one = hn::Set(d, 1), two = hn::Set(d, T(2)), three = hn::Set(d, T(3));
    const auto sixth = hn::Set(d, T(1) / 6), four = hn::Set(d, T(4)), half = hn::Set(d, T(0.5));
    const auto v = hn::Sub(one, u), u2 = hn::Mul(u, u), v2 = hn::Mul(v, v);
    b[0] = hn::Mul(sixth, hn::Mul(v2, v));
    b[1] = hn::Mul(sixth, hn::MulAdd(hn::Mul(three, u2), hn::Sub(u, two), four));
    b[2] = hn::Mul(sixth, hn::MulAdd(hn::Mul(three, v2), hn::Sub(v, two), four));
    b[3] = hn::Mul(sixth, hn::Mul(u2, u));
    const auto slope = hn::Set(d, T(1.5));
    b1[0] = hn::Neg(hn::Mul(half, v2));
    b1[1] = hn::Mul(u, hn::MulSub(slope, u, two));
    b1[2] = hn::Neg(hn::Mul(v, hn::MulSub(slope, v, two)));
    b1[3] = hn::Mul(half, u2);
  }
};

// Bicubic spline on a sphere. Beyond the grid the last cell goes on, without room.
template <class D, class T = hn::TFromD<D>>
LORGNETTE_KERNEL_INLINE GraphJet<D> GridJet(D d, const FaceParams<T>& f, hn::Vec<D> u,
                                            hn::Vec<D> v) {
  const auto zero = hn::Zero(d), one = hn::Set(d, 1), base = hn::Set(d, f.base);
  const auto gx = hn::Mul(hn::Sub(u, hn::Set(d, f.x0)), hn::Set(d, f.per_x));
  const auto gy = hn::Mul(hn::Sub(v, hn::Set(d, f.y0)), hn::Set(d, f.per_y));
  const auto last_x = hn::Set(d, f.nx - 2), last_y = hn::Set(d, f.ny - 2);
  // A coordinate that is no number goes to the first cell.
  const auto cell = [&](hn::Vec<D> at, hn::Vec<D> last) {
    const auto kept = hn::IfThenElseZero(hn::Ge(at, zero), at);
    return hn::Min(hn::Floor(kept), last);
  };
  const auto i = cell(gx, last_x), j = cell(gy, last_y);
  const auto margin = hn::Min(hn::Min(gx, hn::Sub(hn::Add(last_x, one), gx)),
                              hn::Min(gy, hn::Sub(hn::Add(last_y, one), gy)));
  const SplineBasis<D> bx(d, hn::Sub(gx, i)), by(d, hn::Sub(gy, j));
  const std::size_t stride = std::size_t(f.nx) + 2;
  const hn::Rebind<hwy::MakeSigned<T>, D> di;
  const auto index = hn::ConvertTo(di, hn::MulAdd(j, hn::Set(d, T(stride)), i));
  auto z = zero, zx = zero, zy = zero;
  for (std::size_t b = 0; b < 4; ++b) {
    auto along = zero, slope = zero;
    for (std::size_t a = 0; a < 4; ++a) {
      const auto c = hn::GatherIndex(d, f.coefficients + a + b * stride, index);
      along = hn::MulAdd(bx.b[a], c, along);
      slope = hn::MulAdd(bx.b1[a], c, slope);
    }
    z = hn::MulAdd(by.b[b], along, z);
    zx = hn::MulAdd(by.b[b], slope, zx);
    zy = hn::MulAdd(by.b1[b], along, zy);
  }
  const auto r2 = hn::MulAdd(u, u, hn::Mul(v, v));
  const auto e2 = hn::NegMulAdd(hn::Mul(base, base), r2, one);
  const auto e = RootOf(d, e2);
  const auto slope = hn::Div(base, e);
  GraphJet<D> jet;
  // On the grid up to and with its last node.
  jet.room = hn::IfThenElse(hn::Ge(margin, zero), e2, hn::Set(d, T(-1)));
  jet.z = hn::Add(z, hn::Div(hn::Mul(base, r2), hn::Add(one, e)));
  jet.zu = hn::MulAdd(zx, hn::Set(d, f.per_x), hn::Mul(slope, u));
  jet.zv = hn::MulAdd(zy, hn::Set(d, f.per_y), hn::Mul(slope, v));
  return jet;
}

// Any surface with any axis.
template <class D>
struct AnyFace {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  D d;
  const FaceParams<T>& f;
  T sign;

  LORGNETTE_KERNEL_INLINE AnyFace(D tag, const FaceParams<T>& params, T sense)
      : d(tag), f(params), sign(sense) {}

  LORGNETTE_KERNEL_INLINE FaceHit<D> Intersect(const Vec3<D>& p, const Vec3<D>& dir) const {
    if (f.kind == FaceKind::kSphere || f.kind == FaceKind::kTorus) {
      return GeneralFace<D, false>(d, f, sign).Intersect(p, dir);
    }
    return IntersectGraph(p, dir);
  }

 private:
  LORGNETTE_KERNEL_INLINE GraphJet<D> JetAt(V u, V v) const {
    if (f.kind == FaceKind::kConic) return ConicJet(d, f, u, v);
    if (f.kind == FaceKind::kAtoroid) return AtoroidJet(d, f, u, v);
    if (f.kind == FaceKind::kGrid) return GridJet(d, f, u, v);
    return ProgressiveJet(d, f, u, v);
  }

  LORGNETTE_KERNEL_INLINE FaceHit<D> IntersectGraph(const Vec3<D>& p, const Vec3<D>& dir) const {
    constexpr int kMaxSteps = 20;
    constexpr T kResidual_mm = sizeof(T) == 8 ? T(2e-13) : T(2e-5);
    const V zero = hn::Zero(d), one = hn::Set(d, 1), c = hn::Set(d, f.c), sense = hn::Set(d, sign);
    const Vec3<D> a{hn::Set(d, f.ax), hn::Set(d, f.ay), hn::Set(d, f.az)};
    const Vec3<D> g{hn::Set(d, f.gx), hn::Set(d, f.gy), hn::Set(d, f.gz)};
    const Vec3<D> across{hn::Set(d, f.ux), hn::Set(d, f.uy), hn::Set(d, f.uz)};
    const Vec3<D> own{Dot<D>(across, p), Dot<D>(g, p), Dot<D>(a, p)};
    const Vec3<D> way{Dot<D>(across, dir), Dot<D>(g, dir), Dot<D>(a, dir)};

    // The vertex sphere, or the vertex plane where that is missed.
    const V b = hn::NegMulAdd(c, Dot<D>(own, way), way.z);
    const V h = hn::MulSub(c, Dot<D>(own, own), hn::Add(own.z, own.z));
    V root;
    M met;
    V t = StableRoot(d, c, b, h, sense, &root, &met);
    t = hn::IfThenElse(met, t, hn::Neg(hn::Div(own.z, way.z)));
    t = hn::IfThenElse(hn::Lt(hn::Abs(t), hn::Set(d, T(kFarthest_mm))), t, zero);

    GraphJet<D> jet;
    M converged;
    V slope;
    for (int i = 0;; ++i) {
      const Vec3<D> at = Along<D>(own, t, way);
      jet = JetAt(at.x, at.y);
      const V height = hn::Sub(at.z, jet.z);
      slope = hn::NegMulAdd(jet.zu, way.x, hn::NegMulAdd(jet.zv, way.y, way.z));
      converged = hn::Le(hn::Abs(height), hn::Set(d, kResidual_mm));
      if (hn::AllTrue(d, converged) || i == kMaxSteps) break;
      t = hn::Sub(t, hn::Div(height, slope));
    }

    FaceHit<D> hit;
    hit.distance = t;
    hit.point = Along<D>(p, t, dir);
    const V length2 = hn::MulAdd(jet.zu, jet.zu, hn::MulAdd(jet.zv, jet.zv, one));
    const V inverse = hn::Div(one, hn::Sqrt(length2));
    const V nu = hn::Neg(jet.zu), nv = hn::Neg(jet.zv);
    const Vec3<D> n = Along<D>(Along<D>(a, nu, across), nv, g);
    hit.normal = {hn::Mul(n.x, inverse), hn::Mul(n.y, inverse), hn::Mul(n.z, inverse)};
    hit.cosine = hn::Mul(slope, inverse);
    const M near = hn::Lt(hn::Abs(t), hn::Set(d, T(kFarthest_mm)));
    const M with_sense = hn::Gt(hn::Mul(hit.cosine, sense), zero);
    hit.ok = hn::And(hn::And(converged, near), hn::And(with_sense, hn::Gt(jet.room, zero)));
    return hit;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace lorgnette::kernel
HWY_AFTER_NAMESPACE();

#endif
