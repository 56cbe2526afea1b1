// SPDX-License-Identifier: Apache-2.0
#include "validation/cost/stopwatch.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <vector>

namespace lorgnette::validation {
namespace {

using Clock = std::chrono::steady_clock;

double Quantile(const std::vector<double>& sorted, double q) {
  const double at = q * double(sorted.size() - 1);
  const std::size_t low = std::size_t(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (at - double(low)) * (sorted[high] - sorted[low]);
}

}  // namespace

Timing TimeOf(const std::function<void()>& work, const StopwatchOptions& options) {
  work();
  std::vector<double> times;
  double total = 0;
  while (int(times.size()) < options.min_repetitions ||
         (int(times.size()) < options.max_repetitions && total < 1e9 * options.seconds)) {
    const auto start = Clock::now();
    work();
    times.push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count());
    total += times.back();
  }
  std::sort(times.begin(), times.end());
  return {Quantile(times, 0.5), Quantile(times, 0.75) - Quantile(times, 0.25), int(times.size())};
}

double CalibrationNs() {
  constexpr int kLength = 1000000;
  volatile double sink = 0;
  const Timing timing = TimeOf(
      [&] {
        double x = 0.5;
        for (int i = 0; i < kLength; ++i) x = x * 0.999999 + 1e-6;
        sink = x;
      },
      {5, 9, 0.02});
  return timing.median_ns / kLength;
}

std::string MachineName() {
  std::ifstream file("/proc/cpuinfo");
  const std::string key = "model name";
  for (std::string line; std::getline(file, line);) {
    if (line.compare(0, key.size(), key) != 0) continue;
    const std::size_t start = line.find_first_not_of(" \t:", key.size());
    if (start != std::string::npos) return line.substr(start);
  }
  return "unknown";
}

}  // namespace lorgnette::validation
