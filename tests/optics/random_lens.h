// SPDX-License-Identifier: Apache-2.0
// Random lenses for the property tests: log-uniform in power, cylinder, index and thickness, so
// that plano, weak, strong and thick ones all come up. Fixed seeds.
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <random>

#include "base/units.h"
#include "optics/back_surface.h"
#include "optics/lens.h"
#include "optics/power_vector.h"

namespace lorgnette {

inline constexpr int kRandomLenses = 10000;

struct RandomOrder {
  double sphere, cylinder, axis_deg, base, index, thickness_mm;

  PowerVector Power() const {
    return PowerVectorOf({Diopters(sphere), Diopters(cylinder), AxisDegrees(axis_deg)});
  }
  // Exact back vertex power, no limits on the outline.
  Lens Make(ToricGenerator generator = ToricGenerator::kAcrossMinusAxis) const {
    return Make(Power(), generator);
  }
  Lens Make(const PowerVector& power,
            ToricGenerator generator = ToricGenerator::kAcrossMinusAxis) const {
    Lens lens;
    lens.medium.index_d = index;
    lens.center_thickness_mm = thickness_mm;
    lens.front = SphereSurface{base / (1000 * (index - 1))};
    lens.back = ToricSurface(BackCurvature(base * Eigen::Matrix2d::Identity(),
                                           LensFrameMatrix(power), thickness_mm, index, {}),
                             generator, true);
    return lens;
  }
};

class RandomLenses {
 public:
  explicit RandomLenses(unsigned seed) : random_(seed) {}

  // Log-uniform in magnitude over [low, high], either sign.
  double Signed(double low, double high) { return Log(low, high) * (Uniform(0, 1) < 0.5 ? -1 : 1); }
  double Log(double low, double high) { return std::exp(Uniform(std::log(low), std::log(high))); }
  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  // Powers from 1e-6 to `strongest` D, cylinders from 1e-9 to 6, indices 1.05 to 1.9.
  RandomOrder Next(double strongest = 20) {
    RandomOrder o;
    o.sphere = Signed(1e-6, strongest);
    o.cylinder = Signed(1e-9, 6);
    o.axis_deg = Uniform(0, 180);
    o.base = Uniform(0, 1) < 0.1 ? 0 : Log(1e-3, 14);
    o.index = 1 + Log(0.3, 0.9);
    o.thickness_mm = Log(0.05, 12);
    return o;
  }

 private:
  std::mt19937_64 random_;
};

// Keeps the worst of many, and prints it: the tables of docs/optics.md come from here.
class Worst {
 public:
  explicit Worst(const char* what) : what_(what) {}
  ~Worst() { std::printf("[worst] %s: %.2g over %ld\n", what_, value_, count_); }
  void See(double deviation) {
    value_ = std::isnan(deviation) ? HUGE_VAL : std::fmax(value_, std::abs(deviation));
    ++count_;
  }
  double value() const { return value_; }
  long count() const { return count_; }

 private:
  const char* what_;
  double value_ = 0;
  long count_ = 0;
};

}  // namespace lorgnette
