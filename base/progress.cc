// SPDX-License-Identifier: Apache-2.0
#include "base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace lorgnette {
namespace {

constexpr int kBarCells = 30;
constexpr auto kRedrawEvery = std::chrono::milliseconds(100);

std::string Duration(double seconds) {
  const long s = std::lround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  return fmt::format("{}:{:02} min", s / 60, s % 60);
}

}  // namespace

Progress::Progress(std::string title, std::string unit, long total)
    : title_(std::move(title)),
      unit_(std::move(unit)),
      total_(std::max(total, 0L)),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      last_draw_(start_ - kRedrawEvery) {}

Progress::~Progress() {
  if (terminal_ && last_decile_ >= 0) std::fputc('\n', stderr);
}

void Progress::Update(long done) {
  const auto now = std::chrono::steady_clock::now();
  const long shown = std::clamp(done, 0L, total_);
  const long decile = total_ > 0 ? 10 * shown / total_ : 10;
  const bool finished = shown == total_;
  if (terminal_ ? now - last_draw_ < kRedrawEvery && !finished : decile <= last_decile_) return;

  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double rate = elapsed > 0 ? double(shown) / elapsed : 0;
  std::string line = fmt::format("{}/{} {}, {:.1f} {}/s", shown, total_, unit_, rate, unit_);
  if (finished) {
    line += ", took " + Duration(elapsed);
  } else if (rate > 0) {
    line += ", " + Duration(double(total_ - shown) / rate) + " left";
  }
  if (terminal_) {
    const long cells = total_ > 0 ? kBarCells * shown / total_ : kBarCells;
    fmt::print(stderr, "\r{} [{:<{}}] {}\x1b[K", title_, std::string(std::size_t(cells), '#'),
               kBarCells, line);
  } else {
    fmt::print(stderr, "{}: {}\n", title_, line);
  }
  std::fflush(stderr);
  last_draw_ = now;
  last_decile_ = decile;
}

}  // namespace lorgnette
