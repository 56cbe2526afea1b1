// SPDX-License-Identifier: Apache-2.0
// The greatest error over a grid or a sample, and where it was.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "validation/case.h"

namespace lorgnette::validation {

class Worst {
 public:
  // where: text of the place, made only when the error is the greatest so far; NaN counts as
  // infinite.
  template <typename Where>
  void Add(double error, Where&& where) {
    const double magnitude = std::isnan(error) ? INFINITY : std::abs(error);
    ++count_;
    if (magnitude < greatest_ || (count_ > 1 && magnitude == greatest_)) return;
    greatest_ = magnitude;
    where_ = where();
  }
  double greatest() const { return greatest_; }
  long count() const { return count_; }

  // As a check: "QUANTITY, worst of 1234 at PLACE".
  void Report(CaseRun& run, const std::string& quantity, const std::string& unit, double bound,
              const std::string& reason) const {
    run.Bound(fmt::format("{}, worst of {} at {}", quantity, count_, where_), unit,
              count_ > 0 ? greatest_ : INFINITY, bound, reason);
  }

 private:
  double greatest_ = 0;
  long count_ = 0;
  std::string where_;
};

}  // namespace lorgnette::validation
