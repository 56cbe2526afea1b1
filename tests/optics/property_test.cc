// SPDX-License-Identifier: Apache-2.0
// What holds of every lens, whatever its numbers: 10,000 random ones each, the worst case printed.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "optics/magnification.h"
#include "optics/paraxial.h"
#include "optics/pencil.h"
#include "optics/prism.h"
#include "optics/trace.h"
#include "tests/optics/random_lens.h"

namespace lorgnette {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

double Largest(const Matrix2d& m) { return m.cwiseAbs().maxCoeff(); }

Vector2d Turned(const Vector2d& v, double angle) {
  return {std::cos(angle) * v.x() - std::sin(angle) * v.y(),
          std::sin(angle) * v.x() + std::cos(angle) * v.y()};
}

// The lens seen from behind: turned by 180 degrees about y.
Surface Reversed(const Surface& surface) {
  if (const auto* s = std::get_if<SphereSurface>(&surface.shape())) {
    return SphereSurface{-s->curvature};
  }
  const auto& t = std::get<TorusSurface>(surface.shape());
  return TorusSurface{-t.curvature_generator, -t.curvature_across, kPi - t.generator_angle};
}

TEST(Property, DesignedPowerIsTheParaxialPower) {
  RandomLenses random(1);
  Worst worst("back vertex power, design against 2x2 blocks, relative");
  for (int i = 0; i < kRandomLenses; ++i) {
    const RandomOrder o = random.Next();
    const Matrix2d power = SystemOf(o.Make()).BackVertexPower();
    const double scale = 1 + std::abs(o.sphere) + std::abs(o.cylinder) + o.base;
    worst.See(Largest(power - LensFrameMatrix(o.Power())) / scale);
  }
  EXPECT_LT(worst.value(), 1e-14);
}

TEST(Property, DesignedPowerIsTheTracedPower) {
  RandomLenses random(2);
  Worst worst("back vertex power, by rays against the order, D");
  Worst against_stated("the same over the stated error");
  for (int i = 0; i < kRandomLenses; ++i) {
    const RandomOrder o = random.Next();
    const auto pencil = MeasurePower(o.Make(), o.index);
    ASSERT_TRUE(pencil);
    const double error = Largest(pencil->power_D - LensFrameMatrix(o.Power()));
    worst.See(error);
    against_stated.See(error / pencil->power_error_D);
  }
  EXPECT_LT(worst.value(), 1e-7);
  EXPECT_LT(against_stated.value(), 1);
}

TEST(Property, ReversedLensSwapsTheVertexPowers) {
  RandomLenses random(3);
  Worst worst("front vertex power against the reversed lens' back vertex power, relative");
  for (int i = 0; i < kRandomLenses; ++i) {
    const RandomOrder o = random.Next();
    const Lens lens = o.Make();
    Lens reversed = lens;
    reversed.front = Reversed(lens.back);
    reversed.back = Reversed(lens.front);
    Matrix2d mirrored = SystemOf(reversed).BackVertexPower();
    mirrored(0, 1) = -mirrored(0, 1);
    mirrored(1, 0) = -mirrored(1, 0);
    const Matrix2d front = SystemOf(lens).FrontVertexPower();
    worst.See(Largest(front - mirrored) / (1 + Largest(front)));
  }
  EXPECT_LT(worst.value(), 1e-13);
}

TEST(Property, TransposedPrescriptionMakesTheSameSurface) {
  RandomLenses random(4);
  Worst worst("sag of the transposed prescription's lens at 12 mm, mm");
  for (int i = 0; i < kRandomLenses; ++i) {
    const RandomOrder o = random.Next(12);
    RandomOrder t = o;
    t.sphere = o.sphere + o.cylinder;
    t.cylinder = -o.cylinder;
    t.axis_deg = o.axis_deg + (o.axis_deg > 90 ? -90 : 90);
    const double a = random.Uniform(0, 2 * kPi);
    const Vector2d p = 12 * Vector2d(std::cos(a), std::sin(a));
    const auto one = o.Make().back.Jet(p.x(), p.y()), other = t.Make().back.Jet(p.x(), p.y());
    if (!one || !other) continue;
    worst.See(one->z - other->z);
  }
  EXPECT_GT(worst.count(), kRandomLenses * 9 / 10);
  EXPECT_LT(worst.value(), 1e-12);
}

TEST(Property, AxisZeroIsAxisOneEighty) {
  RandomLenses random(5);
  for (int i = 0; i < kRandomLenses; ++i) {
    RandomOrder o = random.Next();
    o.axis_deg = 0;
    const Matrix2d zero = o.Make().back.VertexCurvature();
    o.axis_deg = 180;
    EXPECT_EQ(zero, o.Make().back.VertexCurvature());
  }
}

TEST(Property, MirroredPrescriptionMakesTheMirroredLens) {
  RandomLenses random(6);
  Worst worst("prism at a point against the mirrored lens', prism D");
  for (int i = 0; i < kRandomLenses; ++i) {
    const RandomOrder o = random.Next(12);
    RandomOrder m = o;
    m.axis_deg = 180 - o.axis_deg;
    const Vector2d p(random.Uniform(-8, 8), random.Uniform(-8, 8));
    const auto a = PrismAt(o.Make(), o.index, p);
    const auto b = PrismAt(m.Make(), o.index, {-p.x(), p.y()});
    if (!a || !b) continue;
    worst.See((*a - Vector2d(-b->x(), b->y())).norm());
  }
  EXPECT_GT(worst.count(), kRandomLenses * 9 / 10);
  EXPECT_LT(worst.value(), 1e-11);
}

// Turning the order and the point together turns the answer; J0 and J45 turn by twice the angle.
TEST(Property, TurnedLensTurnsItsPrism) {
  RandomLenses random(7);
  Worst worst("prism at a point against the turned lens', prism D"), twice("J0, J45 turned, D");
  for (int i = 0; i < kRandomLenses; ++i) {
    const RandomOrder o = random.Next(12);
    const double turn_deg = random.Uniform(0, 180), turn = RadiansFromDegrees(turn_deg);
    RandomOrder t = o;
    t.axis_deg = o.axis_deg + turn_deg;
    const Vector2d p(random.Uniform(-8, 8), random.Uniform(-8, 8));
    const auto a = PrismAt(o.Make(), o.index, p);
    // TABO angles run from -x toward +y: a turn by +A there is a turn by -A in (x, y).
    const auto b = PrismAt(t.Make(), o.index, Turned(p, -turn));
    if (!a || !b) continue;
    worst.See((Turned(*a, -turn) - *b).norm());
    const PowerVector u = o.Power(), v = t.Power();
    const Vector2d turned = Turned({u.j0, u.j45}, 2 * turn);
    twice.See((turned - Vector2d(v.j0, v.j45)).norm());
  }
  EXPECT_GT(worst.count(), kRandomLenses * 9 / 10);
  EXPECT_LT(worst.value(), 1e-11);
  EXPECT_LT(twice.value(), 1e-14);
}

TEST(Property, VanishingCylinderIsTheSphere) {
  RandomLenses random(8);
  Worst worst("prism at a point, cylinder 1e-12 D against the sphere, prism D");
  for (int i = 0; i < kRandomLenses; ++i) {
    RandomOrder o = random.Next(12);
    o.cylinder = random.Signed(1e-15, 1e-12);
    RandomOrder sphere = o;
    sphere.cylinder = 0;
    const Vector2d p(random.Uniform(-8, 8), random.Uniform(-8, 8));
    const auto a = PrismAt(o.Make(), o.index, p), b = PrismAt(sphere.Make(), o.index, p);
    if (!a || !b) continue;
    worst.See((*a - *b).norm());
  }
  EXPECT_GT(worst.count(), kRandomLenses * 9 / 10);
  EXPECT_LT(worst.value(), 2e-11);
}

TEST(Property, LensOfIndexOneIsNotThere) {
  RandomLenses random(9);
  Worst worst("deviation by a lens of index 1, mm and radians");
  for (int i = 0; i < kRandomLenses; ++i) {
    const Lens lens = random.Next(12).Make();
    const Vector3d d =
        Vector3d(random.Uniform(-0.3, 0.3), random.Uniform(-0.3, 0.3), 1).normalized();
    const Vector3d p(random.Uniform(-8, 8), random.Uniform(-8, 8), -15);
    const LensTrace trace = TraceThrough(lens, {p, d}, 1.0);
    if (trace.status != RayStatus::kOk) continue;
    const Vector3d off = trace.exit.origin - p;
    worst.See((off - off.dot(d) * d).norm());
    worst.See((trace.exit.direction - d).norm());
  }
  EXPECT_LT(worst.value(), 1e-13);
}

TEST(Property, ScaledLensHasThePowerDivided) {
  RandomLenses random(10);
  Worst worst("prism of a lens scaled by k at k times the point, prism D");
  for (int i = 0; i < kRandomLenses; ++i) {
    const RandomOrder o = random.Next(12);
    const double k = random.Log(0.1, 10);
    RandomOrder scaled = o;
    scaled.sphere /= k;
    scaled.cylinder /= k;
    scaled.base /= k;
    scaled.thickness_mm *= k;
    const Vector2d p(random.Uniform(-8, 8), random.Uniform(-8, 8));
    const auto a = PrismAt(o.Make(), o.index, p), b = PrismAt(scaled.Make(), o.index, k * p);
    if (!a || !b) continue;
    worst.See((*a - *b).norm());
  }
  EXPECT_GT(worst.count(), kRandomLenses * 9 / 10);
  EXPECT_LT(worst.value(), 1e-11);
}

TEST(Property, ThinLensPowersAdd) {
  RandomLenses random(11);
  Worst worst("|F'v - (F1 + F2)| / (tau F1^2 (1 + tau F1)) as tau falls");
  for (int i = 0; i < kRandomLenses; ++i) {
    RandomOrder o = random.Next();
    o.base = random.Log(0.5, 14);
    o.thickness_mm = random.Log(1e-6, 1e-2);
    const Lens lens = o.Make();
    const Matrix2d sum = SurfacePower(lens.front, 1, o.index) + SurfacePower(lens.back, o.index, 1);
    const double tau = o.thickness_mm / 1000 / o.index;
    const double rounding = 1e-14 * (40 + o.base);
    const double missing = Largest(SystemOf(lens).BackVertexPower() - sum) - rounding;
    worst.See(std::fmax(missing, 0) / (tau * o.base * o.base * (1 + tau * o.base)));
  }
  // F1 / (1 - tau F1) - F1 = tau F1^2 (1 + tau F1 + ...): the ratio tends to 1 from below.
  EXPECT_LT(worst.value(), 1 + 1e-6);
}

// F'v and Fn are symmetric always; Fe = F1 + F2 - tau F2 F1 only where the axes agree.
TEST(Property, OnlyThickObliqueLensesCareForTheOrderOfPowers) {
  RandomLenses random(12);
  Worst vertex("asymmetry of F'v and Fn, relative"), aligned("asymmetry of Fe, axes aligned");
  int asymmetric = 0;
  for (int i = 0; i < kRandomLenses; ++i) {
    const double tau = random.Log(1e-4, 8e-3);
    const auto power = [&](double axis_deg) {
      return LensFrameMatrix(
          PowerVectorOf({Diopters(random.Uniform(-15, 15)), Diopters(random.Uniform(1, 6)),
                         AxisDegrees(axis_deg)}));
    };
    const double axis = random.Uniform(0, 180);
    const Matrix2d f1 = power(axis), oblique = power(axis + random.Uniform(10, 80));
    const auto lens = AstigmaticSystem::ThickLens(f1, oblique, 1000 * tau, 1);
    // -C A^-1 and -D^-1 C as they come, without the symmetrising of the accessors.
    for (const Matrix2d& f :
         {Matrix2d(-lens.c_D * lens.a.inverse()), Matrix2d(-lens.d.inverse() * lens.c_D)}) {
      vertex.See((f(0, 1) - f(1, 0)) / (1 + Largest(f)));
    }
    const Matrix2d fe = lens.EquivalentPower();
    asymmetric += std::abs(fe(0, 1) - fe(1, 0)) > 1e-6;
    const Matrix2d same =
        AstigmaticSystem::ThickLens(f1, power(axis), 1000 * tau, 1).EquivalentPower();
    aligned.See((same(0, 1) - same(1, 0)) / (1 + Largest(same)));
  }
  EXPECT_LT(vertex.value(), 1e-13);
  EXPECT_LT(aligned.value(), 1e-14);
  EXPECT_GT(asymmetric, kRandomLenses * 99 / 100);
}

TEST(Property, PrenticeIsTheDerivativeOfTheTrace) {
  RandomLenses random(13);
  Worst worst("central difference of the traced prism against Prentice, prism D a mm, relative");
  constexpr double kStep_mm = 1e-3;
  for (int i = 0; i < kRandomLenses; ++i) {
    const RandomOrder o = random.Next();
    const Lens lens = o.Make();
    const Matrix2d power = SystemOf(lens).EquivalentPower();
    for (const Vector2d& step : {Vector2d(kStep_mm, 0), Vector2d(0, kStep_mm)}) {
      const auto plus = PrismAt(lens, o.index, step), minus = PrismAt(lens, o.index, -step);
      ASSERT_TRUE(plus && minus);
      const Vector2d slope = (*plus - *minus) / 2;
      worst.See((slope - PrenticePrism(power, step)).norm() / kStep_mm /
                (1 + o.base + Largest(power)));
    }
  }
  // Third-order aberration: (h c)^2 with curvatures up to 0.1 / mm, and rounding 1e-14 / h.
  EXPECT_LT(worst.value(), 1e-8);
}

// A camera at L sees the entrance pupil as large as the wearer sees an object at L.
TEST(Property, ObserverAndWearerAreReciprocal) {
  RandomLenses random(14);
  Worst worst("observer's magnification against the wearer's, relative");
  Worst traced("the same, the observer's by rays, over its stated error");
  for (int i = 0; i < kRandomLenses; ++i) {
    RandomOrder o = random.Next();
    o.cylinder = 0;
    const ObserverGeometry view{random.Log(100, 1e5), random.Uniform(5, 30)};
    const auto system = ParaxialSystem::ThickLens(
        Diopters(o.base),
        Diopters(o.sphere - o.base / (1 - o.thickness_mm / 1000 / o.index * o.base)),
        o.thickness_mm, o.index);
    const double seen = ObserverParaxial(system, o.thickness_mm, view).magnification;
    const double wearer =
        SpectacleMagnificationNear(system, o.thickness_mm, view.depth_mm, view.camera_mm);
    worst.See((seen - wearer) / seen);
    const auto rays =
        MeasureObserverMagnification(o.Make(), o.index, view.camera_mm, view.depth_mm);
    ASSERT_TRUE(rays);
    traced.See((rays->magnification(0, 0) - seen) / rays->error);
  }
  EXPECT_LT(worst.value(), 1e-12);
  EXPECT_LT(traced.value(), 1);
}

TEST(Property, RaysAreReversible) {
  constexpr double kReturn_mm = 1e-12;
  RandomLenses random(15);
  Worst worst("distance of the returned ray from its start, mm");
  for (int i = 0; i < kRandomLenses; ++i) {
    RandomOrder o = random.Next(12);
    Lens lens = o.Make();
    lens.back_tilt_x = random.Uniform(-0.08, 0.08);
    lens.back_tilt_y = random.Uniform(-0.08, 0.08);
    const Vector3d start(random.Uniform(-10, 10), random.Uniform(-10, 10), -20);
    const Vector3d d =
        Vector3d(random.Uniform(-0.3, 0.3), random.Uniform(-0.3, 0.3), 1).normalized();
    const LensTrace there = TraceThrough(lens, {start, d});
    if (there.status != RayStatus::kOk) continue;
    const Ray out{there.exit.origin + 30 * there.exit.direction, -there.exit.direction};
    const LensTrace back = TraceThrough(lens, out);
    ASSERT_EQ(back.status, RayStatus::kOk);
    const Vector3d& e = back.exit.direction;
    worst.See((back.exit.origin + (start.z() - back.exit.origin.z()) / e.z() * e - start).norm());
  }
  EXPECT_GT(worst.count(), kRandomLenses * 8 / 10);
  EXPECT_LT(worst.value(), kReturn_mm);
}

// Optical path from a plane wave to the focus is the same along the pencil, but for aberration of
// the fourth power of its width.
TEST(Property, OpticalPathIsEqualAlongThePencilToItsFocus) {
  RandomLenses random(16);
  Worst worst("path of a ray at 0.05 mm less the axial one, mm");
  constexpr double kHeight_mm = 0.05;
  for (int i = 0; i < kRandomLenses; ++i) {
    RandomOrder o = random.Next();
    o.sphere = random.Signed(1, 20);
    o.cylinder = 0;
    const Lens lens = o.Make();
    const double focus_z = o.thickness_mm + 1000 / o.sphere;
    const auto path = [&](double height) {
      const LensTrace t = TraceThrough(lens, {{0, height, -1}, {0, 0, 1}});
      EXPECT_EQ(t.status, RayStatus::kOk);
      // To the focal plane, ahead or behind, and across to the focus itself along the wave's
      // normal: the signed distance of the focus ahead of the exit point on the ray.
      const Vector3d to_focus = Vector3d(0, 0, focus_z) - t.exit.origin;
      return t.first.distance + o.index * (t.second.point - t.first.point).norm() +
             std::copysign(to_focus.norm(), to_focus.z());
    };
    worst.See(path(kHeight_mm) - path(0));
  }
  // W040 h^4 with W040 of some F^3 / 1e10 per mm^3 at most 1e-3: 6e-9 mm; rounding of 1 m: 1e-13.
  EXPECT_LT(worst.value(), 1e-8);
}

TEST(Property, FresnelIsSymmetricAndNeverGainsEnergy) {
  RandomLenses random(17);
  Worst worst("reflectance from either side of an interface");
  for (int i = 0; i < kRandomLenses; ++i) {
    const double n = 1 + random.Log(1e-6, 1);
    const double c = 1 - random.Log(1e-9, 1);
    const double r = FresnelReflectance(c, 1 / n);
    EXPECT_GE(r, 0);
    EXPECT_LE(r, 1);
    const double inside = std::sqrt(1 - (1 - c) * (1 + c) / (n * n));
    worst.See(r - FresnelReflectance(inside, n));
  }
  // Near grazing r changes by cos/cos' of rounding: 1e-16 / cos with cos >= 1e-5.
  EXPECT_LT(worst.value(), 1e-10);
}

}  // namespace
}  // namespace lorgnette
