// SPDX-License-Identifier: Apache-2.0
// Times of pieces of work in one process: several repetitions, median and spread, and a kernel of
// fixed arithmetic to compare machines and moments by.
#pragma once

#include <functional>
#include <string>

namespace lorgnette::validation {

struct Timing {
  double median_ns = 0;  // of one run
  double spread_ns = 0;  // between the quartiles
  int repetitions = 0;
};

struct StopwatchOptions {
  int min_repetitions = 7, max_repetitions = 101;
  double seconds = 0.15;  // enough once the least repetitions are done
};

// Runs the work once to warm up, then until the options are met.
Timing TimeOf(const std::function<void()>& work, const StopwatchOptions& options = {});

// Nanoseconds of one multiply-add in a chain of a million that wait for each other: what the
// processor gives at this moment, whatever it is called.
double CalibrationNs();

// The processor's name as the system has it, or "unknown".
std::string MachineName();

}  // namespace lorgnette::validation
