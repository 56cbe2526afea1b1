// SPDX-License-Identifier: Apache-2.0
// Random lenses for cases that state a property: log-uniform in power and cylinder, so that weak
// and strong ones come up alike. Fixed seeds, the same on every machine.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "optics/design.h"

namespace lorgnette::validation {

class Sampler {
 public:
  explicit Sampler(std::uint64_t seed) : state_(seed) {}
  // SplitMix64 (Steele, Lea, Flood 2014).
  double Uniform(double low, double high) {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return low + (high - low) * (double((z ^ (z >> 31)) >> 11) * 0x1p-53);
  }
  double Log(double low, double high) { return std::exp(Uniform(std::log(low), std::log(high))); }
  double Signed(double low, double high) { return Log(low, high) * (Uniform(0, 1) < 0.5 ? -1 : 1); }

 private:
  std::uint64_t state_;
};

// An order that can be made: 1e-6 to 12 D, cylinders 1e-6 to 6 D, 40 mm across.
inline LensOrder RandomOrder(Sampler& random) {
  LensOrder order;
  order.rx.sphere = Diopters(random.Signed(1e-6, 12));
  order.rx.cylinder = Diopters(-random.Log(1e-6, 6));
  order.rx.axis = AxisDegrees(random.Uniform(0, 180));
  order.medium.index_d = random.Uniform(1.49, 1.75);
  order.diameter_mm = 40;
  return order;
}
inline std::string Where(const LensOrder& order) {
  return fmt::format("{:+.4g} {:+.4g} x {:.1f}, n {:.3f}", order.rx.sphere.value(),
                     order.rx.cylinder.value(), order.rx.axis.value(), order.medium.index_d);
}

// A ray from before the lens to a point within `reach_mm` of its axis.
inline Ray RandomRay(Sampler& random, double reach_mm) {
  const double r = reach_mm * std::sqrt(random.Uniform(0, 1)), a = random.Uniform(0, 2 * kPi);
  const Eigen::Vector3d target(r * std::cos(a), r * std::sin(a), 0);
  const Eigen::Vector3d origin(random.Uniform(-120, 120), random.Uniform(-120, 120),
                               -random.Log(100, 2000));
  return {origin, (target - origin).normalized()};
}

}  // namespace lorgnette::validation
