// SPDX-License-Identifier: Apache-2.0
#include "validation/case.h"

#include <algorithm>
#include <cmath>

namespace lorgnette::validation {
namespace {

constexpr double kMostDigits = 16;

}  // namespace

bool Check::passed() const { return std::abs(measured - expected) <= tolerance; }

double Check::matching_digits() const {
  const double error = std::abs(measured - expected);
  if (!std::isfinite(error)) return 0;
  if (error == 0) return kMostDigits;
  const double scale = expected != 0 ? std::abs(expected) : 1.0;
  return std::clamp(-std::log10(error / scale), 0.0, kMostDigits);
}

void CaseRun::Exact(const std::string& quantity, const std::string& unit, double expected,
                    double measured, int digits) {
  const double scale = expected != 0 ? std::abs(expected) : 1.0;
  checks_.push_back({quantity, unit, expected, measured, scale * std::pow(10.0, -digits),
                     Certainty::kExact, std::to_string(digits) + " digits"});
}

void CaseRun::Rounded(const std::string& quantity, const std::string& unit, double expected,
                      int decimals, double measured, double units_in_last_place) {
  const double unit_in_last_place = std::pow(10.0, -decimals);
  // A hundredth of a unit more, since a half-way case may have been rounded either way.
  checks_.push_back({quantity, unit, expected, measured,
                     (units_in_last_place + 0.01) * unit_in_last_place, Certainty::kRounded,
                     "printed with " + std::to_string(decimals) + " decimals"});
}

void CaseRun::Within(const std::string& quantity, const std::string& unit, double expected,
                     double measured, double tolerance, const std::string& reason) {
  checks_.push_back({quantity, unit, expected, measured, tolerance, Certainty::kEstimated, reason});
}

void CaseRun::Bound(const std::string& quantity, const std::string& unit, double error,
                    double bound, const std::string& reason) {
  checks_.push_back({quantity, unit, 0, std::abs(error), bound, Certainty::kBound, reason});
}

bool CaseRun::passed() const {
  return skipped_.empty() && !checks_.empty() &&
         std::all_of(checks_.begin(), checks_.end(), [](const Check& c) { return c.passed(); });
}

double CaseRun::least_digits() const {
  double least = kMostDigits;
  for (const Check& check : checks_) {
    if (check.certainty != Certainty::kBound) least = std::min(least, check.matching_digits());
  }
  return least;
}

}  // namespace lorgnette::validation
