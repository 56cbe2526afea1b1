// SPDX-License-Identifier: Apache-2.0
// The calibration kernel of a benchmark program: what the machine gives at this moment. Times are
// compared with it, not with the clock (scripts/bench_report.py).
#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>

namespace lorgnette::bench {

// Multiplications and additions in one chain, each waiting for the one before.
inline void Calibration(benchmark::State& state) {
  constexpr int kLength = 100000;
  for (auto _ : state) {
    double x = 0.5;
    for (int i = 0; i < kLength; ++i) x = x * 0.999999 + 1e-6;
    benchmark::DoNotOptimize(x);
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t(kLength));
}

}  // namespace lorgnette::bench
