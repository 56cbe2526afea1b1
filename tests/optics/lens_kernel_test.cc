// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_kernel.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "base/units.h"
#include "optics/trace.h"
#include "tests/optics/lens_oracle.h"

namespace lorgnette {
namespace {

struct NamedLens {
  const char* name;
  Lens lens;
  double index;
};

Lens MakeLens(Surface front, Surface back, double thickness) {
  Lens lens;
  lens.front = front;
  lens.back = back;
  lens.center_thickness_mm = thickness;
  return lens;
}

Surface Sphere(double curvature) { return Surface(SphereSurface{curvature}); }
Surface Torus(double generator, double across, double angle_deg) {
  return Surface(TorusSurface{generator, across, RadiansFromDegrees(angle_deg)});
}

Surface Conic(double curvature, double conic, std::array<double, 4> even) {
  ConicSurface s;
  s.curvature = curvature;
  s.conic = conic;
  s.even = even;
  return Surface(s);
}

// A torus and a ripple, as nodes of a spline, 60 mm across.
Surface Grid(const TorusSurface& torus, double ripple_mm, double base_curvature) {
  constexpr int kNodes = 49;
  constexpr double kPitch = 60.0 / (kNodes - 1);
  Eigen::MatrixXd sag(kNodes, kNodes);
  for (int i = 0; i < kNodes; ++i) {
    for (int j = 0; j < kNodes; ++j) {
      const double x = -30 + i * kPitch, y = -30 + j * kPitch;
      sag(i, j) =
          Surface(torus).Jet(x, y)->z + ripple_mm * (1 - std::cos(x / 8)) * std::cos(y / 11);
    }
  }
  return Surface(GridSurface{std::make_shared<SplineGrid>(
      SplineGrid::Through(sag, -30, -30, kPitch, kPitch, base_curvature))});
}

Surface Atoroid(double generator, double across, double angle_deg) {
  AtoroidSurface s;
  s.curvature_generator = generator;
  s.curvature_across = across;
  s.conic_generator = 0.6;
  s.conic_across = -0.7;
  s.a4_generator = 2e-7;
  s.generator_angle = RadiansFromDegrees(angle_deg);
  return Surface(s);
}

// No long double form of these: the scalar path answers for them.
std::vector<NamedLens> ProgressiveLenses() {
  std::vector<NamedLens> lenses = {
      {"progressive front",
       MakeLens(Surface(ProgressiveSurface(5.0 / 600, 2.0 / 600, 0, 14)), Sphere(7.0 / 600), 2),
       1.6},
      {"turned progressive front",
       MakeLens(Surface(ProgressiveSurface(4.0 / 500, 3.0 / 500, -4, 10, 0.15)),
                Torus(0.009, 0.012, 33), 3),
       1.5},
      {"progressive back",
       MakeLens(Sphere(0.012), Surface(ProgressiveSurface(0.008, -0.004, -2, 16)), 2), 1.6},
      {"flat progressive back",
       MakeLens(Sphere(0.012), Surface(ProgressiveSurface(0, -0.004, 0, 12)), 3), 1.6},
      {"grid front", MakeLens(Grid({0.011, 0.009, 0}, 0.02, 0), Sphere(0.015), 3), 1.6},
      {"grid on a sphere, back", MakeLens(Sphere(0.004), Grid({0.013, 0.016, 0}, 0.01, 0.0145), 2),
       1.5},
      {"atoroid back", MakeLens(Sphere(1 / 300.0), Atoroid(1 / 54.47, 1 / 74.86, 25), 1.5), 1.6},
      {"atoroid front", MakeLens(Atoroid(0.012, 0.015, 110), Torus(0.01, 0.012, 40), 4), 1.67}};
  NamedLens prism = lenses[5];
  prism.name = "grid with prism";
  prism.lens.back_tilt_x = -0.03;
  prism.lens.back_tilt_y = 0.04;
  lenses.push_back(prism);
  prism = lenses[2];
  prism.name = "progressive back with prism";
  prism.lens.back_tilt_x = 0.03;
  prism.lens.back_tilt_y = -0.02;
  lenses.push_back(prism);
  return lenses;
}

std::vector<NamedLens> TestLenses() {
  std::vector<NamedLens> lenses = {
      {"-6 D", MakeLens(Sphere(1 / 300.0), Sphere(1 / 74.9647941931), 1.5), 1.6},
      {"+6 D", MakeLens(Sphere(0.015), Sphere(1 / 141.0), 5), 1.6},
      {"plano", MakeLens(Sphere(0), Sphere(0), 2), 1.5},
      {"1e-12 D", MakeLens(Sphere(2e-15), Sphere(1e-15), 2), 1.5},
      {"-20 D", MakeLens(Sphere(0.001), Sphere(1 / 24.4), 1), 1.5},
      {"equal indices", MakeLens(Sphere(0.01), Sphere(-0.01), 5), 1.0},
      {"toric back", MakeLens(Sphere(4.0 / 600), Torus(1 / 54.47, 1 / 74.86, 120), 1.5), 1.6},
      {"barrel back", MakeLens(Sphere(4.0 / 600), Torus(1 / 74.86, 1 / 54.47, 30), 1.5), 1.6},
      {"near-sphere torus", MakeLens(Sphere(0.008), Torus(1 / 60.0, 1 / (60 + 1e-7), 10), 2), 1.5},
      {"cylinder back", MakeLens(Sphere(0.01), Torus(0, 0.012, 77), 2), 1.5},
      {"capstan back", MakeLens(Sphere(0.01), Torus(0.01, -0.008, 5), 3), 1.67},
      {"toric front", MakeLens(Torus(0.017, 0.011, 45), Sphere(0.005), 4), 1.74},
      {"aspheric front", MakeLens(Conic(0.015, -0.8, {-4e-7, 1e-10, 0, 0}), Sphere(1 / 141.0), 6),
       1.6},
      {"parabolic back", MakeLens(Sphere(0.002), Conic(0.016, -1, {}), 1.5), 1.6},
      {"hyperbolic plano", MakeLens(Conic(0.01, -5, {}), Torus(0.01, 0.014, 20), 2), 1.5},
      {"oblate both", MakeLens(Conic(0.01, 1.5, {}), Conic(0.012, 0.4, {2e-7, 0, 0, 0}), 2), 1.5}};
  NamedLens prism = lenses[0];
  prism.name = "-6 D with prism";
  prism.lens.back_tilt_x = 0.05;
  prism.lens.back_tilt_y = -0.03;
  lenses.push_back(prism);
  prism = lenses[6];
  prism.name = "toric back with prism";
  prism.lens.back_tilt_x = -0.04;
  prism.lens.back_tilt_y = 0.07;
  lenses.push_back(prism);
  return lenses;
}

std::vector<NamedLens> AllLenses() {
  std::vector<NamedLens> lenses = TestLenses();
  for (const NamedLens& named : ProgressiveLenses()) lenses.push_back(named);
  return lenses;
}

// n rays in arrays, and room for all that the kernel can return about them.
template <typename T>
struct Batch {
  explicit Batch(std::size_t count)
      : n(count),
        in(6 * n),
        exit(6 * n, -7),
        first(6 * n, -7),
        inside(6 * n, -7),
        second(6 * n, -7),
        r1(n, -7),
        r2(n, -7),
        status(n, 9) {}
  std::size_t n;
  std::vector<T> in, exit, first, inside, second, r1, r2;
  std::vector<std::uint8_t> status;

  static RayArrays<T> Arrays(std::vector<T>& v, std::size_t n) {
    return {v.data(),         v.data() + n,     v.data() + 2 * n,
            v.data() + 3 * n, v.data() + 4 * n, v.data() + 5 * n};
  }
  RayArrays<const T> Input() const {
    return {in.data(),         in.data() + n,     in.data() + 2 * n,
            in.data() + 3 * n, in.data() + 4 * n, in.data() + 5 * n};
  }
  void Set(std::size_t i, const Ray& ray) {
    for (int k = 0; k < 3; ++k) {
      in[std::size_t(k) * n + i] = T(ray.origin[k]);
      in[std::size_t(k + 3) * n + i] = T(ray.direction[k]);
    }
  }
  oracle::Vec At(const std::vector<T>& v, std::size_t i, std::size_t field) const {
    return {v[field * n + i], v[(field + 1) * n + i], v[(field + 2) * n + i]};
  }
  void Trace(const Lens& lens, double index) {
    auto a1 = Arrays(first, n), a2 = Arrays(inside, n), a3 = Arrays(second, n);
    TraceLensBatch(lens, index, Input(), n,
                   {Arrays(exit, n), status.data(), &a1, &a2, &a3, r1.data(), r2.data()});
  }
};

// Rays from 500 mm and from near by, toward points up to 28 mm off the axis, steep ones included.
std::vector<Ray> TestRays(std::size_t n, bool forward, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1), turn(0, 2 * kPi);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < n; ++i) {
    const double radius = 28 * std::sqrt(unit(random)), a = turn(random), b = turn(random);
    const Eigen::Vector3d aim(radius * std::cos(a), radius * std::sin(a), 0);
    const double slope = std::pow(10.0, -3 + 3.3 * unit(random));  // tangents 0.001 to 2
    Eigen::Vector3d dir(slope * std::cos(b), slope * std::sin(b), 1);
    if (!forward) dir.z() = -1;
    dir.normalize();
    rays.push_back({aim - (i % 2 == 0 ? 500 : 20) * dir, dir});
  }
  return rays;
}

// What a test lets a comparison skip: rays this near to grazing or to the critical angle, where an
// error of the input's last bit decides what happens.
constexpr double kDecided = 0.17;  // cosine of 80 degrees

template <typename T>
struct Worst {
  double position_mm = 0, direction = 0, reflectance = 0;
  std::size_t compared = 0, rays = 0;
};

template <typename T>
Worst<T> CompareWithOracle(const NamedLens& named, bool forward) {
  const std::vector<Ray> rays = TestRays(2000, forward, 17);
  Batch<T> batch(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) batch.Set(i, rays[i]);
  batch.Trace(named.lens, named.index);
  Worst<T> worst;
  worst.rays = rays.size();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const oracle::Vec dir = batch.At(batch.in, i, 3).normalized();
    const auto expected =
        oracle::TraceLens(named.lens, batch.At(batch.in, i, 0), dir, T(named.index));
    // Cosine after the second surface, from Snell's law.
    const oracle::Real s2 =
        named.index * named.index * (1 - expected.cosine_second * expected.cosine_second);
    if (expected.cosine_first < kDecided ||
        (expected.cosine_second > 0 && std::abs(1 - s2) < kDecided * kDecided) ||
        expected.status == RayStatus::kMissesSurface) {
      EXPECT_LE(int(batch.status[i]), 2);
      continue;
    }
    ++worst.compared;
    EXPECT_EQ(RayStatus(batch.status[i]), expected.status) << named.name << " ray " << i;
    if (RayStatus(batch.status[i]) != expected.status) continue;
    const auto position = [&](const std::vector<T>& v, const oracle::Vec& p) {
      worst.position_mm = std::max(worst.position_mm, double((batch.At(v, i, 0) - p).norm()));
    };
    const auto direction = [&](const std::vector<T>& v, const oracle::Vec& d) {
      worst.direction = std::max(worst.direction, double((batch.At(v, i, 3) - d).norm()));
    };
    position(batch.first, expected.first.point);
    direction(batch.first, expected.first.normal);
    position(batch.inside, expected.second.point);
    direction(batch.inside, expected.inside);
    direction(batch.second, expected.second.normal);
    if (expected.status == RayStatus::kOk) {
      position(batch.exit, expected.second.point);
      direction(batch.exit, expected.exit);
    }
    worst.reflectance =
        std::max({worst.reflectance,
                  std::abs(double(batch.r1[i]) -
                           FresnelReflectance(double(expected.cosine_first), 1 / named.index)),
                  std::abs(double(batch.r2[i]) -
                           FresnelReflectance(double(expected.cosine_second), named.index))});
  }
  return worst;
}

TEST(LensKernel, DoubleAgreesWithLongDoubleWithinItsBound) {
  Worst<double> all;
  for (const NamedLens& named : TestLenses()) {
    for (const bool forward : {true, false}) {
      const auto worst = CompareWithOracle<double>(named, forward);
      EXPECT_GT(worst.compared, worst.rays / 3) << named.name;
      EXPECT_LT(worst.position_mm, kLensKernelDoublePositionError_mm) << named.name;
      // Curvatures below 0.05 / mm turn a position error into twenty times less of direction;
      // the second direction is divided by a cosine above kDecided.
      EXPECT_LT(worst.direction, kLensKernelDoublePositionError_mm) << named.name;
      EXPECT_LT(worst.reflectance, 1e-10) << named.name;
      all.position_mm = std::max(all.position_mm, worst.position_mm);
      all.direction = std::max(all.direction, worst.direction);
    }
  }
  std::printf("double: worst position %.2g mm, direction %.2g\n", all.position_mm, all.direction);
}

TEST(LensKernel, FloatAgreesWithLongDoubleWithinItsBound) {
  Worst<float> all;
  for (const NamedLens& named : TestLenses()) {
    for (const bool forward : {true, false}) {
      const auto worst = CompareWithOracle<float>(named, forward);
      EXPECT_GT(worst.compared, worst.rays / 3) << named.name;
      EXPECT_LT(worst.position_mm, kLensKernelFloatPositionError_mm) << named.name;
      EXPECT_LT(worst.direction, kLensKernelFloatPositionError_mm) << named.name;
      EXPECT_LT(worst.reflectance, 1e-3) << named.name;  // steep near the critical angle
      all.position_mm = std::max(all.position_mm, worst.position_mm);
      all.direction = std::max(all.direction, worst.direction);
    }
  }
  std::printf("float: worst position %.2g mm, direction %.2g\n", all.position_mm, all.direction);
}

TEST(LensKernel, AgreesWithTheScalarPathRayByRay) {
  std::size_t different = 0, rays_traced = 0;
  double worst = 0;
  for (const NamedLens& named : AllLenses()) {
    for (const bool forward : {true, false}) {
      const std::vector<Ray> rays = TestRays(2000, forward, 3);
      Batch<double> batch(rays.size());
      for (std::size_t i = 0; i < rays.size(); ++i) batch.Set(i, rays[i]);
      batch.Trace(named.lens, named.index);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const LensTrace scalar = TraceThrough(named.lens, rays[i], named.index);
        ++rays_traced;
        if (RayStatus(batch.status[i]) != scalar.status) {
          ++different;
          continue;
        }
        if (scalar.status != RayStatus::kOk) continue;
        const double error =
            (batch.At(batch.exit, i, 0).cast<double>() - scalar.exit.origin).norm();
        // Grazing rays included: the hit moves by rounding over the cosine there.
        EXPECT_LT(error, 1e-8) << named.name << " ray " << i;
        const double cosine = std::abs(rays[i].direction.dot(scalar.first.normal));
        if (cosine > kDecided) {
          worst = std::max(
              worst, (batch.At(batch.first, i, 0).cast<double>() - scalar.first.point).norm());
        }
      }
    }
  }
  // Statuses may differ only where rounding decides: grazing, or the last bit of a sheet's end.
  std::printf("statuses that differ from the scalar path: %zu of %zu; first hits by %.2g mm\n",
              different, rays_traced, worst);
  EXPECT_LT(different, rays_traced / 1000);
  EXPECT_LT(worst, kLensKernelDoublePositionError_mm);
}

template <typename T>
void ExpectTailsEqualWholeBatches() {
  for (const NamedLens& named : AllLenses()) {
    const std::vector<Ray> rays = TestRays(70, true, 5);
    Batch<T> whole(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) whole.Set(i, rays[i]);
    whole.Trace(named.lens, named.index);
    for (std::size_t n = 1; n <= 35; ++n) {
      Batch<T> part(n);
      for (std::size_t i = 0; i < n; ++i) part.Set(i, rays[i]);
      part.Trace(named.lens, named.index);
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_EQ(part.status[i], whole.status[i]) << named.name << " n " << n;
        // Neighbours in a register may add Newton steps, never take them away.
        const T bound = T(64) * std::numeric_limits<T>::epsilon();
        for (const std::size_t field : {0u, 3u}) {
          ASSERT_LT((part.At(part.exit, i, field) - whole.At(whole.exit, i, field)).norm(),
                    bound * 30)
              << named.name;
          ASSERT_LT((part.At(part.first, i, field) - whole.At(whole.first, i, field)).norm(),
                    bound * 30)
              << named.name;
        }
        ASSERT_NEAR(part.r2[i], whole.r2[i], bound * 100);
      }
    }
  }
}
TEST(LensKernel, RaggedTailsEqualWholeBatchesInDouble) { ExpectTailsEqualWholeBatches<double>(); }
TEST(LensKernel, RaggedTailsEqualWholeBatchesInFloat) { ExpectTailsEqualWholeBatches<float>(); }

template <typename T>
void ExpectNoNanWhateverGoesIn() {
  const T nan = std::numeric_limits<T>::quiet_NaN(), inf = std::numeric_limits<T>::infinity();
  const T big = std::numeric_limits<T>::max();
  const T values[] = {T(0), T(1), T(-1), T(1e-30), T(1e4), big, inf, -inf, nan};
  std::mt19937_64 random(11);
  std::uniform_int_distribution<std::size_t> pick(0, std::size(values) - 1);
  for (const NamedLens& named : AllLenses()) {
    Batch<T> batch(501);
    for (T& v : batch.in) v = values[pick(random)];
    batch.in[5 * batch.n] = 1;  // the first ray says which way
    batch.Trace(named.lens, named.index);
    for (std::size_t i = 0; i < batch.n; ++i) {
      ASSERT_LE(int(batch.status[i]), 2);
      for (std::size_t f = 0; f < 6; ++f) {
        ASSERT_FALSE(std::isnan(batch.exit[f * batch.n + i])) << named.name;
        ASSERT_FALSE(std::isnan(batch.first[f * batch.n + i])) << named.name;
        ASSERT_FALSE(std::isnan(batch.inside[f * batch.n + i])) << named.name;
      }
      ASSERT_FALSE(std::isnan(batch.r1[i]));
      ASSERT_FALSE(std::isnan(batch.r2[i]));
      if (RayStatus(batch.status[i]) == RayStatus::kOk) continue;
      for (std::size_t f = 0; f < 6; ++f) ASSERT_EQ(batch.exit[f * batch.n + i], T(0));
    }
  }
}
TEST(LensKernel, ReturnsNoNanWhateverGoesInDouble) { ExpectNoNanWhateverGoesIn<double>(); }
TEST(LensKernel, ReturnsNoNanWhateverGoesInFloat) { ExpectNoNanWhateverGoesIn<float>(); }

TEST(LensKernel, SurfacesWithoutASimdFormGiveTheScalarAnswer) {
  BifocalSurface bifocal;
  bifocal.curvature = 0.012;
  bifocal.curvature_segment = 0.016;
  bifocal.center = {2, -9};
  bifocal.radius = 14;
  bifocal.top = 5;
  const Lens lens = MakeLens(Surface(bifocal), Sphere(0.01), 3);
  const std::vector<Ray> rays = TestRays(50, true, 29);
  Batch<double> batch(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) batch.Set(i, rays[i]);
  batch.Trace(lens, 1.6);
  int compared = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const LensTrace scalar = TraceThrough(lens, rays[i], 1.6);
    ASSERT_EQ(RayStatus(batch.status[i]), scalar.status);
    if (scalar.status != RayStatus::kOk) continue;
    ++compared;
    EXPECT_LT((batch.At(batch.exit, i, 0).cast<double>() - scalar.exit.origin).norm(), 1e-12);
    EXPECT_LT((batch.At(batch.second, i, 3).cast<double>() - scalar.second.normal).norm(), 1e-12);
  }
  EXPECT_GT(compared, 20);
}

TEST(LensKernel, RayThatTravelsTheOtherWayMisses) {
  Batch<double> batch(2);
  batch.Set(0, {{1, 2, -50}, {0, 0, 1}});
  batch.Set(1, {{1, 2, 50}, {0, 0, -1}});
  batch.Trace(TestLenses()[0].lens, 1.6);
  EXPECT_EQ(RayStatus(batch.status[0]), RayStatus::kOk);
  EXPECT_EQ(RayStatus(batch.status[1]), RayStatus::kMissesSurface);
}

template <typename T>
void ExpectAxialRaysMeetTheVertices() {
  // A parabola has no quadratic term along its axis, a plane no root but one: 0 / 0 in forms that
  // divide by a curvature.
  for (const NamedLens& named : AllLenses()) {
    if (named.lens.back_tilt_x != 0) continue;
    for (const bool forward : {true, false}) {
      Batch<T> batch(3);
      const double z = forward ? 1 : -1;
      for (std::size_t i = 0; i < 3; ++i) batch.Set(i, {{0, 0, -400 * z}, {0, 0, z}});
      batch.Trace(named.lens, named.index);
      for (std::size_t i = 0; i < 3; ++i) {
        ASSERT_EQ(RayStatus(batch.status[i]), RayStatus::kOk) << named.name;
        const double second = forward ? named.lens.center_thickness_mm : 0;
        EXPECT_NEAR(double(batch.At(batch.exit, i, 0).z()), second,
                    400 * std::numeric_limits<T>::epsilon())
            << named.name;
        EXPECT_NEAR(double(batch.At(batch.exit, i, 3).z()), z,
                    8 * std::numeric_limits<T>::epsilon())
            << named.name;
      }
    }
  }
}
TEST(LensKernel, AxialRaysMeetTheVerticesInDouble) { ExpectAxialRaysMeetTheVertices<double>(); }
TEST(LensKernel, AxialRaysMeetTheVerticesInFloat) { ExpectAxialRaysMeetTheVertices<float>(); }

template <typename T>
void ExpectGrazingRaysEndCleanly() {
  // Parallel to the axis at the height where each sphere stands upright: the discriminant cancels.
  const double radius = 74.9647941931;
  const Lens lens = MakeLens(Sphere(0), Sphere(1 / radius), 1.5);
  std::vector<double> heights;
  for (double step = 1e-18; step < 1; step *= 10) {
    heights.push_back(radius * (1 - step));
    heights.push_back(radius * (1 + step));
  }
  Batch<T> batch(heights.size());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    batch.Set(i, {{0, heights[i], -10}, {0, 0, 1}});
  }
  batch.Trace(lens, 1.5);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double outside = heights[i] / radius - 1;
    const auto status = RayStatus(batch.status[i]);
    // Steeper than the critical angle from 2 / 3 of the radius on; never through.
    EXPECT_NE(status, RayStatus::kOk);
    if (outside > 1e-5) {
      EXPECT_EQ(status, RayStatus::kMissesSurface);
    }
    if (outside < -1e-5 && outside > -0.3) {
      EXPECT_EQ(status, RayStatus::kTotalInternalReflection);
    }
    if (status != RayStatus::kTotalInternalReflection) continue;
    EXPECT_EQ(double(batch.r2[i]), 1);
    const double sag =
        radius - std::sqrt(std::max(0.0, (radius - heights[i]) * (radius + heights[i])));
    // Next to upright the sag moves by the root of the height's rounding.
    EXPECT_NEAR(double(batch.At(batch.inside, i, 0).z()), 1.5 + sag,
                4 * radius * std::sqrt(std::numeric_limits<T>::epsilon()));
  }
}
TEST(LensKernel, GrazingRaysEndCleanlyInDouble) { ExpectGrazingRaysEndCleanly<double>(); }
TEST(LensKernel, GrazingRaysEndCleanlyInFloat) { ExpectGrazingRaysEndCleanly<float>(); }

TEST(LensKernel, TracesThroughSurfacesThatHaveCrossed) {
  // Beyond the knife edge of a plus lens the back lies before the front: the step is negative, and
  // the trace goes on as the scalar path does.
  const Lens lens = MakeLens(Sphere(0.02), Sphere(-0.01), 2);
  Batch<double> batch(1);
  const Ray ray{{0, 20, -30}, {0, 0, 1}};
  batch.Set(0, ray);
  batch.Trace(lens, 1.5);
  const LensTrace scalar = TraceThrough(lens, ray, 1.5);
  ASSERT_EQ(RayStatus(batch.status[0]), scalar.status);
  EXPECT_LT(batch.At(batch.exit, 0, 0).z(), batch.At(batch.first, 0, 0).z());
  EXPECT_LT((batch.At(batch.exit, 0, 0).cast<double>() - scalar.exit.origin).norm(), 1e-12);
}

TEST(LensKernel, EveryInstructionSetOfThisMachineAgrees) {
  const NamedLens named = TestLenses()[6];
  const std::vector<Ray> rays = TestRays(100, true, 23);
  Batch<double> best(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) best.Set(i, rays[i]);
  best.Trace(named.lens, named.index);
  int targets = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();  // choose anew at the next call
    Batch<double> other(rays.size());
    other.in = best.in;
    other.Trace(named.lens, named.index);
    ++targets;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(other.status[i], best.status[i]) << LensKernelTarget();
      EXPECT_LT((other.At(other.exit, i, 0) - best.At(best.exit, i, 0)).norm(),
                kLensKernelDoublePositionError_mm)
          << LensKernelTarget();
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();  // choose anew at the next call
  EXPECT_GE(targets, 1);
  std::printf("compared %d instruction sets; this machine runs %s\n", targets, LensKernelTarget());
}

// --- TraceFaceBatch -------------------------------------------------------------------------

struct FaceBatch {
  Batch<double> hit{1}, refracted{1}, reflected{1};
  std::vector<double> reflectance;
  std::vector<std::uint8_t> status;
  FaceBatch(const Lens& lens, LensFace face, double index, const Batch<double>& in)
      : hit(in.n), refracted(in.n), reflected(in.n), reflectance(in.n), status(in.n) {
    auto out = Batch<double>::Arrays(refracted.exit, in.n);
    auto back = Batch<double>::Arrays(reflected.exit, in.n);
    TraceFaceBatch(
        lens, face, index, in.Input(), in.n,
        {Batch<double>::Arrays(hit.exit, in.n), status.data(), &out, &back, reflectance.data()});
  }
};

TEST(LensKernelFace, FollowsTheSecondHalfOfALensTrace) {
  const NamedLens named = TestLenses()[6];
  const std::vector<Ray> rays = TestRays(333, true, 2);
  Batch<double> batch(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) batch.Set(i, rays[i]);
  batch.Trace(named.lens, named.index);
  Batch<double> within(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    within.Set(i, {batch.At(batch.first, i, 0).cast<double>(),
                   batch.At(batch.inside, i, 3).cast<double>()});
  }
  const FaceBatch face(named.lens, LensFace::kBack, named.index, within);
  int compared = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (RayStatus(batch.status[i]) != RayStatus::kOk) continue;
    // Thin enough to cross behind the origin: a different question.
    if ((batch.At(batch.exit, i, 0) - batch.At(batch.first, i, 0)).z() <= 0.01) continue;
    ++compared;
    ASSERT_EQ(face.status[i], batch.status[i]);
    EXPECT_LT((face.hit.At(face.hit.exit, i, 0) - batch.At(batch.exit, i, 0)).norm(),
              kLensKernelDoublePositionError_mm);
    EXPECT_LT((face.refracted.At(face.refracted.exit, i, 3) - batch.At(batch.exit, i, 3)).norm(),
              kLensKernelDoublePositionError_mm);
    EXPECT_NEAR(face.reflectance[i], batch.r2[i], 1e-12);
  }
  EXPECT_GT(compared, 100);
}

TEST(LensKernelFace, MirrorsAboutTheNormalAndChainsToTheOtherFace) {
  const NamedLens named = TestLenses()[1];
  Batch<double> within(40);
  for (std::size_t i = 0; i < within.n; ++i) {
    const double h = 0.4 * double(i);
    within.Set(i, {{0.2 * h, h, named.lens.front.Jet(0.2 * h, h)->z},
                   Eigen::Vector3d(0.01, -0.1, 1).normalized()});
  }
  const FaceBatch back(named.lens, LensFace::kBack, named.index, within);
  Batch<double> returned(within.n);
  for (std::size_t i = 0; i < within.n; ++i) {
    ASSERT_EQ(RayStatus(back.status[i]), RayStatus::kOk);
    const Eigen::Vector3d normal = back.hit.At(back.hit.exit, i, 3).cast<double>();
    const Eigen::Vector3d in(within.At(within.in, i, 3).cast<double>());
    const Eigen::Vector3d mirrored = back.reflected.At(back.reflected.exit, i, 3).cast<double>();
    EXPECT_LT((mirrored - Reflect(in, normal)).norm(), 1e-15 * 8);
    returned.Set(i, {back.hit.At(back.hit.exit, i, 0).cast<double>(), mirrored});
  }
  const FaceBatch front(named.lens, LensFace::kFront, named.index, returned);
  for (std::size_t i = 0; i < within.n; ++i) {
    ASSERT_EQ(RayStatus(front.status[i]), RayStatus::kOk);
    const Eigen::Vector3d p = front.hit.At(front.hit.exit, i, 0).cast<double>();
    EXPECT_NEAR(p.z(), named.lens.front.Jet(p.x(), p.y())->z, 1e-13);
  }
}

TEST(LensKernelFace, ReportsTotalReflectionWithItsMirrorDirection) {
  Batch<double> within(3);
  const double critical = std::asin(1 / 1.5);
  const double angles[] = {critical - 1e-6, critical + 1e-6, 1.2};
  for (std::size_t i = 0; i < 3; ++i) {
    within.Set(i, {{0, 0, 0}, {std::sin(angles[i]), 0, std::cos(angles[i])}});
  }
  const FaceBatch face(MakeLens(Sphere(0), Sphere(0), 2), LensFace::kBack, 1.5, within);
  EXPECT_EQ(RayStatus(face.status[0]), RayStatus::kOk);
  for (const std::size_t i : {1u, 2u}) {
    EXPECT_EQ(RayStatus(face.status[i]), RayStatus::kTotalInternalReflection);
    EXPECT_EQ(face.reflectance[i], 1);
    EXPECT_EQ(face.refracted.At(face.refracted.exit, i, 3).norm(), 0);
    EXPECT_NEAR(double(face.reflected.At(face.reflected.exit, i, 3).z()), -std::cos(angles[i]),
                1e-15);
    EXPECT_NEAR(double(face.hit.At(face.hit.exit, i, 0).x()), 2 * std::tan(angles[i]), 1e-14);
  }
}

TEST(LensKernelFace, IgnoresCrossingsBehindTheOrigin) {
  Batch<double> within(1);
  within.Set(0, {{0, 0, 3}, {0, 0, 1}});  // already behind the back vertex
  const FaceBatch face(MakeLens(Sphere(0), Sphere(0), 2), LensFace::kBack, 1.5, within);
  EXPECT_EQ(RayStatus(face.status[0]), RayStatus::kMissesSurface);
}

}  // namespace
}  // namespace lorgnette
