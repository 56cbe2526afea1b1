// SPDX-License-Identifier: Apache-2.0
#include "optics/surface_shapes.h"

#include <cmath>

#include "base/check.h"

namespace lorgnette {
namespace {

// A profile of revolution f(r^2) with its first two derivatives by r^2 = s.
struct Radial {
  double f, fs, fss;
};

SurfaceJet JetOfRadial(const Radial& p, double x, double y) {
  return {p.f,
          2 * x * p.fs,
          2 * y * p.fs,
          2 * p.fs + 4 * x * x * p.fss,
          4 * x * y * p.fss,
          2 * p.fs + 4 * y * y * p.fss};
}

// A meridian curve g(v) and the curvature kappa(v) of the conic sections across it, p = 1 + k.
struct Swept {
  double g, g1, g2;  // sag and derivatives by v
  double k, k1, k2;  // section curvature and derivatives by v
  double p = 1;
};

// z(u, v) = g(v) + f(kappa(v), u),  f = kappa u^2 / (1 + e),  e = sqrt(1 - p kappa^2 u^2)
std::optional<SurfaceJet> JetOfSwept(const Swept& s, double u) {
  const double e2 = 1 - s.p * s.k * s.k * u * u;
  if (!(e2 > 0)) return std::nullopt;
  const double e = std::sqrt(e2), e3 = e2 * e, u2 = u * u;
  const double f_k = u2 / (e * (1 + e));
  const double f_kk = s.p * s.k * u2 * u2 * (1 + 2 * e) / (e3 * (1 + e) * (1 + e));
  SurfaceJet jet;
  jet.z = s.g + s.k * u2 / (1 + e);
  jet.zx = s.k * u / e;
  jet.zy = s.g1 + f_k * s.k1;
  jet.zxx = s.k / e3;
  jet.zxy = u / e3 * s.k1;
  jet.zyy = s.g2 + f_kk * s.k1 * s.k1 + f_k * s.k2;
  return jet;
}

}  // namespace

SurfaceJet RotatedJet(const SurfaceJet& j, double si, double co) {
  SurfaceJet r;
  r.z = j.z;
  r.zx = si * j.zx + co * j.zy;
  r.zy = si * j.zy - co * j.zx;
  r.zxx = si * si * j.zxx + 2 * si * co * j.zxy + co * co * j.zyy;
  r.zyy = co * co * j.zxx - 2 * si * co * j.zxy + si * si * j.zyy;
  r.zxy = (si * si - co * co) * j.zxy + si * co * (j.zyy - j.zxx);
  return r;
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

std::optional<SurfaceJet> JetOf(const TorusSurface& s, double x, double y) {
  const double co = std::cos(s.generator_angle), si = std::sin(s.generator_angle);
  const double cu = s.curvature_across, cv = s.curvature_generator;
  const double u = si * x - co * y, v = co * x + si * y;
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
  return RotatedJet(jet, si, co);
}

std::optional<SurfaceJet> JetOf(const ConicSurface& s, double x, double y) {
  const double c = s.curvature, p = 1 + s.conic, r2 = x * x + y * y;
  const double e2 = 1 - p * c * c * r2;
  if (!(e2 > 0)) return std::nullopt;
  const double e = std::sqrt(e2);
  Radial f{c * r2 / (1 + e), 0.5 * c / e, 0.25 * p * c * c * c / (e2 * e)};
  double power = 1;  // r2^(m - 2)
  for (std::size_t i = 0; i < s.even.size(); ++i) {
    const double a = s.even[i], m = double(i) + 2;  // a r^(2m)
    f.f += a * power * r2 * r2;
    f.fs += a * m * power * r2;
    f.fss += a * m * (m - 1) * power;
    power *= r2;
  }
  return JetOfRadial(f, x, y);
}

std::optional<SurfaceJet> JetOf(const AtoroidSurface& s, double x, double y) {
  const double co = std::cos(s.generator_angle), si = std::sin(s.generator_angle);
  const double u = si * x - co * y, v = co * x + si * y, v2 = v * v;
  const double c = s.curvature_generator, p = 1 + s.conic_generator;
  const double e2 = 1 - p * c * c * v2;
  if (!(e2 > 0)) return std::nullopt;
  const double e = std::sqrt(e2);
  Swept swept;
  swept.g = c * v2 / (1 + e) + s.a4_generator * v2 * v2;
  swept.g1 = c * v / e + 4 * s.a4_generator * v2 * v;
  swept.g2 = c / (e2 * e) + 12 * s.a4_generator * v2;
  const double scale = 1 - s.curvature_across * swept.g;
  if (!(scale > 0)) return std::nullopt;
  swept.k = s.curvature_across / scale;
  swept.k1 = swept.k * swept.k * swept.g1;
  swept.k2 = swept.k * (2 * swept.k1 * swept.g1 + swept.k * swept.g2);
  swept.p = 1 + s.conic_across;
  const auto jet = JetOfSwept(swept, u);
  return jet ? std::optional(RotatedJet(*jet, si, co)) : std::nullopt;
}

BifocalSurface::Frame BifocalSurface::SegmentFrame() const {
  const auto main = JetOf(SphereSurface{curvature}, center.x(), center.y());
  LG_CHECK(main.has_value());
  const Eigen::Vector3d normal = Eigen::Vector3d(-main->zx, -main->zy, 1).normalized();
  double rise = 0;
  if (radius > 0) {
    const auto own = JetOf(SphereSurface{curvature_segment}, radius, 0);
    const auto around = JetOf(SphereSurface{curvature}, radius, 0);
    LG_CHECK(own.has_value() && around.has_value());
    rise = own->z - around->z;
  }
  return {Eigen::Vector3d(center.x(), center.y(), main->z) - rise * normal, normal};
}

bool BifocalSurface::Holds(const Frame& frame, const Eigen::Vector3d& point) const {
  if (point.y() > center.y() + top) return false;
  if (radius == 0) return true;
  const Eigen::Vector3d d = point - frame.vertex;
  return (d - d.dot(frame.normal) * frame.normal).squaredNorm() < radius * radius;
}

std::optional<SurfaceJet> JetOf(const BifocalSurface& s, double x, double y) {
  const auto main = JetOf(SphereSurface{s.curvature}, x, y);
  if (y > s.center.y() + s.top) return main;
  // The segment's sphere c |q - V|^2 = 2 N . (q - V) as a graph over (x, y).
  const BifocalSurface::Frame frame = s.SegmentFrame();
  const Eigen::Vector3d& n = frame.normal;
  const double c = s.curvature_segment;
  const double dx = x - frame.vertex.x(), dy = y - frame.vertex.y();
  const double h = c * (dx * dx + dy * dy) - 2 * (n.x() * dx + n.y() * dy);
  const double disc = n.z() * n.z() - c * h;
  if (!(disc > 0)) return s.radius == 0 ? std::nullopt : main;
  const double w = h / (n.z() + std::sqrt(disc));
  if (!s.Holds(frame, {x, y, frame.vertex.z() + w})) return main;
  const double d = n.z() - c * w;
  SurfaceJet jet;
  jet.z = frame.vertex.z() + w;
  jet.zx = (c * dx - n.x()) / d;
  jet.zy = (c * dy - n.y()) / d;
  jet.zxx = c * (1 + jet.zx * jet.zx) / d;
  jet.zxy = c * jet.zx * jet.zy / d;
  jet.zyy = c * (1 + jet.zy * jet.zy) / d;
  return jet;
}

struct ProgressiveSurface::Meridian {
  double curvature, curvature1, curvature2;  // of the umbilic, derivatives by y
  double phi;                                // sine of its slope angle
};

namespace {

// The step of the reference, its derivatives and its integral from 0; u is clamped by the callers.
double Step(double u) { return u * u * u * (10 + u * (-15 + 6 * u)); }
double Step1(double u) { return 30 * u * u * (1 - u) * (1 - u); }
double Step2(double u) { return 60 * u * (1 - u) * (1 - 2 * u); }
double StepIntegral(double u) { return u * u * u * u * (2.5 + u * (-3 + u)); }

// Sixteen-point Gauss-Legendre on [-1, 1], positive half.
constexpr double kNode[8] = {0.0950125098376374402, 0.2816035507792589132, 0.4580167776572273863,
                             0.6178762444026437484, 0.7554044083550030339, 0.8656312023878317439,
                             0.9445750230732325761, 0.9894009349916499326};
constexpr double kWeight[8] = {0.1894506104550684963, 0.1826034150449235889, 0.1691565193950025382,
                               0.1495959888165767321, 0.1246289712555338720, 0.0951585116824927848,
                               0.0622535239386478929, 0.0271524594117540949};

// Height gained on a circle of curvature c between slope sines a and b.
double ArcRise(double c, double a, double b) {
  if (c == 0) return 0;
  return (b * b - a * a) / (c * (std::sqrt(1 - a * a) + std::sqrt(1 - b * b)));
}

}  // namespace

// phi(y) = far y - add length S(u), u = (start - y) / length: zero at the vertex.
double ProgressiveSurface::SlopeSine(double y) const {
  const double u = (start_ - y) / length_;
  const double integral = u <= 0 ? 0 : u >= 1 ? u - 0.5 : StepIntegral(u);
  return far_ * y - add_ * length_ * integral;
}

ProgressiveSurface::ProgressiveSurface(double curvature_far, double curvature_add, double start,
                                       double length, double angle)
    : far_(curvature_far), add_(curvature_add), start_(start), length_(length), angle_(angle) {
  const double top = SlopeSine(start_);
  if (std::abs(top) >= 1) return;
  corridor_end_sag_ = ArcRise(far_, 0, top);
  for (int i = 0; i < 16; ++i) {
    const double x = i < 8 ? -kNode[i] : kNode[i - 8], w = kWeight[i % 8];
    const double phi = SlopeSine(start_ - 0.5 * length_ * (1 + x));
    corridor_end_sag_ -= 0.5 * length_ * w * phi / std::sqrt(1 - phi * phi);
  }
}

bool ProgressiveSurface::MeridianAt(double y, Meridian& m) const {
  m.phi = SlopeSine(y);
  const double u = (start_ - y) / length_;
  const double inside = u > 0 && u < 1 ? 1 : 0;
  const double v = u <= 0 ? 0 : u >= 1 ? 1 : u;
  m.curvature = far_ + add_ * Step(v);
  m.curvature1 = -inside * add_ * Step1(v) / length_;
  m.curvature2 = inside * add_ * Step2(v) / (length_ * length_);
  return std::abs(m.phi) < 1;
}

std::optional<SurfaceJet> ProgressiveSurface::OwnJet(double x, double y) const {
  Meridian m;
  if (!MeridianAt(y, m)) return std::nullopt;
  const double end = start_ - length_;
  Swept s;
  if (y >= start_) {
    s.g = ArcRise(far_, 0, m.phi);
  } else if (y <= end) {
    s.g = corridor_end_sag_ + ArcRise(far_ + add_, SlopeSine(end), m.phi);
  } else {
    s.g = ArcRise(far_, 0, SlopeSine(start_));
    const double half = 0.5 * (start_ - y);
    for (int i = 0; i < 16; ++i) {
      const double t = i < 8 ? -kNode[i] : kNode[i - 8];
      const double phi = SlopeSine(start_ - half * (1 + t));
      s.g -= half * kWeight[i % 8] * phi / std::sqrt(1 - phi * phi);
    }
  }
  const double w2 = 1 - m.phi * m.phi, w = std::sqrt(w2), w3 = w2 * w;
  const double c = m.curvature;
  s.g1 = m.phi / w;
  s.g2 = c / w3;
  s.k = c / w;
  s.k1 = m.curvature1 / w + c * c * m.phi / w3;
  s.k2 = m.curvature2 / w + (3 * c * m.curvature1 * m.phi + c * c * c) / w3 +
         3 * c * c * c * m.phi * m.phi / (w3 * w2);
  return JetOfSwept(s, x);
}

std::optional<SurfaceJet> JetOf(const ProgressiveSurface& s, double x, double y) {
  if (s.angle() == 0) return s.OwnJet(x, y);
  // The umbilic's direction v, at `angle` from +y toward -x, and u across it.
  const double co = -std::sin(s.angle()), si = std::cos(s.angle());
  const auto jet = s.OwnJet(si * x - co * y, co * x + si * y);
  return jet ? std::optional(RotatedJet(*jet, si, co)) : std::nullopt;
}

}  // namespace lorgnette
