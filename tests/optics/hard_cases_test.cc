// SPDX-License-Identifier: Apache-2.0
// The rows of docs/optics.md, "Hard cases": each test states the failure that it guards against.
// (Torus quartics, plano spheres and grazing rays: surface_test.cc. Random lenses:
// property_test.cc.)
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "optics/certify.h"
#include "optics/design.h"
#include "optics/lens_kernel.h"
#include "optics/paraxial.h"
#include "optics/power_vector.h"
#include "optics/prism.h"
#include "optics/trace.h"
#include "tests/optics/orders.h"
#include "tests/optics/random_lens.h"

namespace lorgnette {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::HasSubstr;

LensOrder SmallOrder(double sphere, double cylinder = 0, double axis = 180) {
  return test::Order160(sphere, cylinder, axis, 40);
}

// One ray through the batch kernel.
template <typename T>
struct KernelRay {
  RayStatus status;
  Vector3d origin, direction;
};
template <typename T>
KernelRay<T> TraceByKernel(const Lens& lens, const Ray& ray) {
  T in[6], out[6];
  for (int k = 0; k < 3; ++k) {
    in[k] = T(ray.origin[k]);
    in[3 + k] = T(ray.direction[k]);
  }
  std::uint8_t status = 0;
  const RayArrays<const T> source{in, in + 1, in + 2, in + 3, in + 4, in + 5};
  LensBatchOutput<T> sink{{out, out + 1, out + 2, out + 3, out + 4, out + 5}, &status};
  TraceLensBatch(lens, lens.medium.index_d, source, 1, sink);
  return {RayStatus(status), Vector3d(out[0], out[1], out[2]), Vector3d(out[3], out[4], out[5])};
}

// Plano and weak lenses. A centre-form sphere errs by 1.2e-2 mm at 1e-12 D; here a lens of 1e-12 D
// still deviates by 1e-12 of its prism, to the last digit of the direction.
TEST(HardCase, WeakLensesDeviateAsPrenticeSays) {
  for (double power = 1e-12; power < 1; power *= 10) {
    LensOrder order = SmallOrder(power);
    order.base_curve = Diopters(0);
    order.center_thickness_mm = 2;
    const Lens lens = DesignLens(order)->lens;
    const auto prism = PrismAt(lens, 1.6, {10, 0});
    ASSERT_TRUE(prism);
    // A unit vector's component rounds at 1e-16, 100 of them to the prism dioptre.
    EXPECT_NEAR(prism->x(), -power, 1e-3 * power * power + 2e-14) << power;
    const auto f = TraceByKernel<float>(lens, {{10, 0, -5}, {0, 0, 1}});
    ASSERT_EQ(f.status, RayStatus::kOk);
    const LensTrace exact = TraceThrough(lens, {{10, 0, -5}, {0, 0, 1}});
    EXPECT_NEAR(f.direction.x(), exact.exit.direction.x(), 2e-7) << power;
  }
}

// Steep and hyperbolic conics: the root nearest the vertex is the wrong one, and for k = -1 the
// quadratic's leading term vanishes for axial rays.
TEST(HardCase, ConicsKeepToTheSheetOfTheVertex) {
  for (const double k : {-1.0, -1.0 - 1e-12, -4.0, -0.5, 3.0}) {
    const Surface s = ConicSurface{1 / 15.0, k, {}};
    for (double x = 0; x < 7; x += 0.5) {
      const auto axial = s.Intersect({{x, 0, -30}, {0, 0, 1}});
      ASSERT_TRUE(axial) << k << " " << x;
      EXPECT_NEAR(axial->point.z(), s.Jet(x, 0)->z, 1e-14);
      const Vector3d d = Vector3d(-0.7, 0.1, 1).normalized();
      const Vector3d target(x, 1, s.Jet(x, 1)->z);
      const auto oblique = s.Intersect({target - 25 * d, d});
      ASSERT_TRUE(oblique) << k << " " << x;
      EXPECT_LT((oblique->point - target).norm(), 1e-13) << k << " " << x;
    }
  }
}

// A back surface of -20 D at n = 1.5 has no sag beyond 24.4 mm: rays there miss, none is NaN, in
// double and float alike.
TEST(HardCase, RaysBeyondTheSagMiss) {
  LensOrder order = SmallOrder(-20);
  order.medium.index_d = 1.5;
  order.base_curve = Diopters(0.5);
  const Lens lens = DesignLens(order)->lens;
  int lost = 0;
  for (double y = 20; y < 30; y += 0.25) {
    const Ray ray{{0, y, -5}, {0, 0, 1}};
    const LensTrace trace = TraceThrough(lens, ray);
    lost += trace.status != RayStatus::kOk;
    EXPECT_TRUE(trace.exit.origin.allFinite() && trace.exit.direction.allFinite());
    const auto f = TraceByKernel<float>(lens, ray);
    EXPECT_TRUE(f.origin.allFinite() && f.direction.allFinite());
    if (y > 25) {
      EXPECT_NE(trace.status, RayStatus::kOk);
      EXPECT_NE(f.status, RayStatus::kOk);
    }
  }
  EXPECT_GT(lost, 20);
}

TEST(HardCase, LensesOfThirtyDioptersAreMadeOrRefusedWithReason) {
  for (const double power : {-30.0, -20.0, 20.0, 30.0}) {
    LensOrder order = SmallOrder(power);
    order.medium.index_d = 1.74;
    order.diameter_mm = 30;
    const auto design = DesignLens(order);
    ASSERT_TRUE(design) << power << ": " << design.error().message;
    EXPECT_TRUE(Certify(*design)) << Certify(*design).error().message;
    order.diameter_mm = 70;
    const auto wide = DesignLens(order);
    if (!wide) {
      EXPECT_THAT(wide.error().message, HasSubstr("possible"));
    }
  }
}

// Two cylinders that cancel leave an axis of noise: the comparison is in J0 and J45.
TEST(HardCase, CancellingCylindersLeaveNoAxis) {
  RandomLenses random(21);
  for (int i = 0; i < 1000; ++i) {
    const double c = random.Uniform(-6, 6), axis = random.Uniform(0, 180);
    const PowerVector a = PowerVectorOf({Diopters(1), Diopters(c), AxisDegrees(axis)});
    const PowerVector b = PowerVectorOf({Diopters(1 + c), Diopters(-c), AxisDegrees(axis + 90)});
    // b is a's transposition, so a - b is nothing at all.
    EXPECT_LT(std::hypot(a.j0 - b.j0, a.j45 - b.j45), 1e-14);
    const SphereCylinder rest = MinusCylinderForm({0, a.j0 - b.j0, a.j45 - b.j45});
    EXPECT_LT(std::abs(rest.cylinder.value()), 3e-14);
    EXPECT_TRUE(std::isfinite(rest.axis.value()));
  }
  // Certify does not look at an axis below 0.01 D.
  for (const double c : {0.0, -1e-12, -0.005}) {
    const auto lens = Certify(*DesignLens(SmallOrder(-3, c, 77)));
    ASSERT_TRUE(lens);
    for (const Measurement& m : lens->certificate().measurements) EXPECT_NE(m.quantity, "axis");
  }
}

// Knife edge: a plus lens too thin at the centre would have crossed surfaces.
TEST(HardCase, CrossedSurfacesAreNeverMade) {
  LensOrder order = SmallOrder(6);
  const double least = DesignLens(order)->lens.center_thickness_mm;
  for (double t = 0.2; t < least + 1; t += 0.2) {
    order.center_thickness_mm = t;
    const auto design = DesignLens(order);
    if (design) {
      EXPECT_GE(design->min_edge_thickness_mm, 0) << t;
    } else {
      EXPECT_THAT(design.error().message, HasSubstr("cross")) << t;
      EXPECT_LT(t, least);
    }
  }
  order.center_thickness_mm = std::nextafter(least, 0.0);
  EXPECT_TRUE(DesignLens(order));
}

// tau F1 = 1 puts the back focus on the back vertex: F'v is infinite, and designs stop at 0.5.
TEST(HardCase, DesignsKeepAwayFromThePoleOfTheBackVertexPower) {
  for (const double thickness : {10.0, 30.0, 60.0, 100.0, 101.0, 1000.0}) {
    LensOrder order = SmallOrder(5);
    order.base_curve = Diopters(16);
    order.center_thickness_mm = thickness;
    order.diameter_mm = 20;
    const auto design = DesignLens(order);
    if (thickness / 1000 / 1.6 * 16 > 0.5) {
      ASSERT_FALSE(design) << thickness;
      EXPECT_THAT(design.error().message, HasSubstr("tau F1"));
    } else {
      EXPECT_TRUE(design) << design.error().message;
    }
  }
}

// Equal indices: a radius from a power is 0/0 in design, and the trace passes straight through.
TEST(HardCase, EqualIndicesAreRefusedInDesignAndTransparentInTracing) {
  for (const double n : {1.0, 1 + 1e-7, 0.9, std::numeric_limits<double>::quiet_NaN()}) {
    LensOrder order = SmallOrder(-3);
    order.medium.index_d = n;
    EXPECT_FALSE(DesignLens(order)) << n;
  }
  Lens lens = DesignLens(SmallOrder(-3))->lens;
  lens.medium.index_d = 1;
  const Vector3d d = Vector3d(0.2, 0.1, 1).normalized();
  EXPECT_LT((TraceThrough(lens, {{1, 2, -9}, d}).exit.direction - d).norm(), 4e-16);
  EXPECT_LT((TraceByKernel<float>(lens, {{1, 2, -9}, d}).direction - d).norm(), 3e-7);
}

// A steep lens at a steep angle: inside, past asin(1/n), the light stays.
TEST(HardCase, TotalReflectionIsAStatusInDoubleAndFloat) {
  Lens wedge;
  wedge.medium.index_d = 1.74;
  wedge.center_thickness_mm = 5;
  const double critical = std::asin(1 / 1.74);
  for (const double offset : {-1e-3, 1e-3}) {
    wedge.back_tilt_x = critical + offset;
    const Ray ray{{0, 0, -5}, {0, 0, 1}};
    const RayStatus want = offset > 0 ? RayStatus::kTotalInternalReflection : RayStatus::kOk;
    EXPECT_EQ(TraceThrough(wedge, ray).status, want);
    EXPECT_EQ(TraceByKernel<double>(wedge, ray).status, want);
    EXPECT_EQ(TraceByKernel<float>(wedge, ray).status, want);
    EXPECT_TRUE(TraceThrough(wedge, ray).exit.direction.allFinite());
  }
}

// A ray that leaves by the edge: the second surface is met far outside the outline or not at all.
TEST(HardCase, RaysOutByTheEdgeDoNotLookLikeRaysThroughTheLens) {
  LensOrder order = SmallOrder(-10);
  const LensDesign design = *DesignLens(order);
  const Vector3d d = Vector3d(1, 0, 0.12).normalized();
  const LensTrace trace = TraceThrough(design.lens, {Vector3d(18, 0, 0) - 5 * d, d});
  if (trace.status == RayStatus::kOk) {
    EXPECT_GT(trace.exit.origin.head<2>().norm(), order.diameter_mm / 2);
  } else {
    EXPECT_TRUE(trace.exit.direction.isZero());
  }
}

// Concentric and afocal lenses have no cardinal points; powers, traces and certificates do not
// care.
TEST(HardCase, AfocalLensesAreLensesToo) {
  LensOrder afocal = SmallOrder(0);
  afocal.base_curve = Diopters(8);
  afocal.center_thickness_mm = 4;
  const LensDesign design = *DesignLens(afocal);
  EXPECT_TRUE(Certify(design)) << Certify(design).error().message;
  const ParaxialSystem system =
      ParaxialSystem::ThickLens(design.front_power, design.back_power_axis, 4, 1.6);
  EXPECT_NEAR(system.BackVertexPower().value(), 0, 1e-14);
  // Concentric: r2 = r1 - t.
  Lens concentric = design.lens;
  concentric.front = SphereSurface{1 / 60.0};
  concentric.back = SphereSurface{1 / 56.0};
  const auto prism = PrismAt(concentric, 1.6, {5, 5});
  ASSERT_TRUE(prism);
  EXPECT_TRUE(prism->allFinite());
}

// Prism by 1 - cos loses half the digits near the normal; a wedge of 1e-9 radians keeps them.
TEST(HardCase, TinyPrismsKeepTheirDigits) {
  for (double prism = 1e-9; prism < 10; prism *= 10) {
    LensOrder order = SmallOrder(0);
    order.base_curve = Diopters(0);
    order.rx.prism_up = PrismDiopters(prism);
    const LensDesign design = *DesignLens(order);
    const auto measured = PrismAt(design.lens, 1.6, {0, 0});
    ASSERT_TRUE(measured);
    EXPECT_NEAR(measured->y() / prism, 1, 4e-14 / prism + 4e-16) << prism;
  }
}

// Powers by second differences of a float sag are useless; the kernel's float rays are not.
TEST(HardCase, FloatRaysSeeThePower) {
  for (const double power : {-12.0, -6.0, 4.0}) {
    const Lens lens = DesignLens(SmallOrder(power))->lens;
    const double h = 2;
    const auto plus = TraceByKernel<float>(lens, {{0, h, -5}, {0, 0, 1}});
    const auto exact = TraceThrough(lens, {{0, h, -5}, {0, 0, 1}});
    ASSERT_EQ(plus.status, RayStatus::kOk);
    const double by_float = -1000 * plus.direction.y() / plus.direction.z() / plus.origin.y();
    const double by_double =
        -1000 * exact.exit.direction.y() / exact.exit.direction.z() / exact.exit.origin.y();
    // A float direction rounds at 6e-8 to 3e-7, which over 2 mm is 1.5e-4 D.
    EXPECT_NEAR(by_float, by_double, 3e-4);
  }
}

TEST(HardCase, NonFiniteOrdersAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  LensOrder order = SmallOrder(nan);
  EXPECT_FALSE(DesignLens(order));
  order = SmallOrder(-3);
  order.base_curve = Diopters(nan);
  EXPECT_FALSE(DesignLens(order));
  order = SmallOrder(-3);
  order.contour_mm = {{0, 0}, {nan, 1}, {1, 1}};
  EXPECT_FALSE(DesignLens(order));
  order = SmallOrder(-3);
  order.contour_mm = {{0, 0}, {1, 1}};
  EXPECT_FALSE(DesignLens(order));
}

// Whatever is ordered, the answer is a lens that certifies or a sentence; never a crash, never NaN.
TEST(HardCase, RandomOrdersCertifyOrSayWhy) {
  RandomLenses random(22);
  int made = 0, refused = 0;
  constexpr int kOrders = 150;
  for (int i = 0; i < kOrders; ++i) {
    LensOrder order =
        SmallOrder(random.Signed(1e-9, 35), random.Signed(1e-9, 8), random.Uniform(0, 180));
    order.medium.index_d = 1 + random.Log(0.3, 0.9);
    order.diameter_mm = random.Uniform(20, 80);
    order.rx.prism_in = PrismDiopters(random.Signed(1e-9, 8));
    order.rx.prism_up = PrismDiopters(random.Signed(1e-9, 8));
    if (random.Uniform(0, 1) < 0.3) order.base_curve = Diopters(random.Uniform(-5, 20));
    if (random.Uniform(0, 1) < 0.3) order.center_thickness_mm = random.Log(0.3, 30);
    const auto design = DesignLens(order);
    if (!design) {
      ++refused;
      EXPECT_FALSE(design.error().message.empty());
      EXPECT_EQ(design.error().message.find("nan"), std::string::npos) << design.error().message;
      continue;
    }
    ++made;
    EXPECT_TRUE(std::isfinite(design->mass_g) && design->mass_g > 0);
    EXPECT_GE(design->min_edge_thickness_mm, 0);
    const auto lens = Certify(*design);
    EXPECT_TRUE(lens) << order.rx.sphere.value() << " " << order.rx.cylinder.value() << ": "
                      << lens.error().message;
  }
  std::printf("[worst] random orders: %d made and certified, %d refused\n", made, refused);
  EXPECT_GT(made, kOrders / 4);
}

}  // namespace
}  // namespace lorgnette
