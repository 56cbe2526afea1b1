// SPDX-License-Identifier: Apache-2.0
// Progress of a long job on standard error: a bar with rate and time left on a terminal, a quiet
// line every ten per cent elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace lorgnette {

class Progress {
 public:
  // total: number of steps; unit: "frames"; title: "rendering".
  Progress(std::string title, std::string unit, long total);
  ~Progress();  // ends the line
  void Update(long done);

 private:
  std::string title_, unit_;
  long total_;
  long last_decile_ = -1;
  bool terminal_;
  std::chrono::steady_clock::time_point start_, last_draw_;
};

}  // namespace lorgnette
