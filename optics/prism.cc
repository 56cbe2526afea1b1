// SPDX-License-Identifier: Apache-2.0
#include "optics/prism.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "optics/paraxial.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

constexpr int kMaxPrismSteps = 30;
constexpr double kSingular_D = 1e-3;  // a power below it moves no prism within any lens

}  // namespace

Eigen::Vector2d PrismInLensFrame(Eye eye, double prism_in, double prism_up) {
  return {NasalSign(eye) * prism_in, prism_up};
}
double PrismIn(Eye eye, const Eigen::Vector2d& prism) { return NasalSign(eye) * prism.x(); }

Eigen::Vector2d PrenticePrism(const Eigen::Matrix2d& power_D, const Eigen::Vector2d& r_mm) {
  return -power_D * r_mm / 10;
}

std::optional<Eigen::Vector2d> PrismAt(const Lens& lens, double index,
                                       const Eigen::Vector2d& r_mm) {
  const LensTrace trace = TraceThrough(lens, {{r_mm.x(), r_mm.y(), -1}, {0, 0, 1}}, index);
  if (trace.status != RayStatus::kOk) return std::nullopt;
  return Eigen::Vector2d(100 * trace.exit.direction.head<2>() / trace.exit.direction.z());
}

Result<Eigen::Vector2d> DecenterForPrism(const Lens& lens, const Eigen::Vector2d& prism,
                                         double max_mm) {
  const double n = lens.medium.index_d;
  const Eigen::Matrix2d power = SystemOf(lens, n).EquivalentPower();
  const auto refuse = [&](const char* why) {
    return Failure(
        fmt::format("prism: {:.2f} prism D by decentration: {}; possible: grind it, or "
                    "up to {:.2f} prism D in the direction of greatest power",
                    prism.norm(), why, max_mm / 10 * power.norm()));
  };
  // Least-norm start: a meridian without power takes part only when nothing is asked of it.
  const Eigen::Matrix2d symmetric = 0.5 * (power + power.transpose());
  const double mean = 0.5 * symmetric.trace();
  const double half = std::hypot(0.5 * (symmetric(0, 0) - symmetric(1, 1)), symmetric(0, 1));
  const double angle = 0.5 * std::atan2(2 * symmetric(0, 1), symmetric(0, 0) - symmetric(1, 1));
  Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();
  for (const auto& [value, a] : {std::pair{mean + half, angle}, {mean - half, angle + kPi / 2}}) {
    const Eigen::Vector2d u(std::cos(a), std::sin(a));
    if (std::abs(value) > kSingular_D) {
      inverse += u * u.transpose() / value;
    } else if (std::abs(u.dot(prism)) > kDecentrationTolerance_D) {
      return refuse("the lens has no power in that direction");
    }
  }
  Eigen::Vector2d r(0, 0);
  for (int i = 0; i < kMaxPrismSteps; ++i) {
    const auto at = PrismAt(lens, n, r);
    if (!at) return refuse("rays do not pass the lens there");
    const Eigen::Vector2d missing = prism - *at;
    if (missing.norm() < kDecentrationTolerance_D) return r;
    r -= 10 * inverse * missing;
    if (r.norm() > max_mm) return refuse("the optical centre would move too far");
  }
  return refuse("no point of the lens has it");
}

PrismPlan PlanPrism(const Lens& lens, const Eigen::Vector2d& prism, double max_mm) {
  if (const auto r = DecenterForPrism(lens, prism, max_mm)) return {*r, {0, 0}};
  return {{0, 0}, prism};
}

std::optional<double> VerticalImbalance(const Lens& right, const Lens& left, double drop_mm) {
  const auto r = PrismAt(right, right.medium.index_d, {0, -drop_mm});
  const auto l = PrismAt(left, left.medium.index_d, {0, -drop_mm});
  return r && l ? std::optional(r->y() - l->y()) : std::nullopt;
}

std::optional<SlabOff> PlanSlabOff(const Lens& right, const Lens& left, double drop_mm) {
  const auto imbalance = VerticalImbalance(right, left, drop_mm);
  if (!imbalance) return std::nullopt;
  if (std::abs(*imbalance) < kLeastSlabOff) return SlabOff{};
  // Below its centre a minus lens has its base down: the one with less base up gets it.
  return SlabOff{*imbalance < 0 ? Eye::kRight : Eye::kLeft, std::abs(*imbalance)};
}

}  // namespace lorgnette
