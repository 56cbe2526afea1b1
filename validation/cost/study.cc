// SPDX-License-Identifier: Apache-2.0
#include "validation/cost/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace lorgnette::validation {
namespace {

// Whether a is at least as accurate as b in every unit.
bool AsAccurate(const CostPoint& a, const CostPoint& b) {
  for (std::size_t i = 0; i < b.errors.size(); ++i) {
    if (!(std::max(a.errors[i], kRoundingError) <= std::max(b.errors[i], kRoundingError))) {
      return false;
    }
  }
  return true;
}

std::optional<std::size_t> UnitIndex(const CostStudy& study, const std::string& name) {
  for (std::size_t i = 0; i < study.units.size(); ++i) {
    if (study.units[i].name == name) return i;
  }
  return std::nullopt;
}

struct Quantity {
  double value;
  std::string unit;
};
std::optional<Quantity> ParseQuantity(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || !std::isfinite(value) || value <= 0) return std::nullopt;
  std::string unit(rest, end);
  unit.erase(0, unit.find_first_not_of(' '));
  return Quantity{value, unit};
}

constexpr std::array<const char*, 6> kErrorUnits = {"px",     "magnification", "D",
                                                    "arcmin", "ratio",         "levels"};

}  // namespace

void MarkFront(CostStudy& study) {
  for (CostPoint& point : study.points) {
    point.front =
        std::none_of(study.points.begin(), study.points.end(), [&](const CostPoint& other) {
          if (&other == &point || !AsAccurate(other, point)) return false;
          // Of two equals the first stays.
          return other.time < point.time ||
                 (other.time == point.time && (!AsAccurate(point, other) || &other < &point));
        });
  }
}

Result<CostBudget> ParseBudget(const std::string& max_error, const std::string& max_time) {
  CostBudget budget;
  if (!max_error.empty()) {
    auto quantity = ParseQuantity(max_error);
    if (quantity && quantity->unit == "%") *quantity = {quantity->value / 100, "magnification"};
    if (!quantity ||
        std::find(kErrorUnits.begin(), kErrorUnits.end(), quantity->unit) == kErrorUnits.end()) {
      return UsageError(fmt::format(
          "--max-error: got {}, want a number above 0 and its unit: px, %, D, arcmin, ratio or "
          "levels",
          max_error));
    }
    budget.max_error = quantity->value;
    budget.error_unit = quantity->unit;
  }
  if (!max_time.empty()) {
    const auto quantity = ParseQuantity(max_time);
    const double scale = !quantity                ? 0
                         : quantity->unit == "us" ? 1e-3
                         : quantity->unit == "ms" ? 1
                         : quantity->unit == "s"  ? 1e3
                                                  : 0;
    if (scale == 0) {
      return UsageError(fmt::format(
          "--max-time: got {}, want a number above 0 and its unit a frame: us, ms or s", max_time));
    }
    budget.max_ms = quantity->value * scale;
  }
  return budget;
}

bool Applies(const CostStudy& study, const CostBudget& budget) {
  return (budget.max_error && UnitIndex(study, budget.error_unit)) ||
         (budget.max_ms && study.ms_per_frame > 0);
}

const CostPoint* Recommend(const CostStudy& study, const CostBudget& budget) {
  if (!Applies(study, budget)) return nullptr;
  const auto unit = UnitIndex(study, budget.error_unit);
  const bool bounded = budget.max_error && unit;
  const bool timed = budget.max_ms.has_value() && study.ms_per_frame > 0;
  const CostPoint* best = nullptr;
  for (const CostPoint& point : study.points) {
    if (bounded && point.errors[*unit] > *budget.max_error) continue;
    if (timed && point.time * study.ms_per_frame > *budget.max_ms) continue;
    const bool better =
        best == nullptr || (bounded ? point.time < best->time : point.errors[0] < best->errors[0]);
    if (better) best = &point;
  }
  return best;
}

}  // namespace lorgnette::validation
