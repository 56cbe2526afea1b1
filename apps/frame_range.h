// SPDX-License-Identifier: Apache-2.0
// Part of a clip, by frame numbers from 0.
#pragma once

#include <limits>
#include <string>

#include "base/result.h"

namespace lorgnette {

struct FrameRange {
  long first = 0;
  long last = std::numeric_limits<long>::max();  // included

  bool Contains(long frame) const { return frame >= first && frame <= last; }
  bool IsWhole() const { return first == 0 && last == std::numeric_limits<long>::max(); }
  // How many of `total` frames it takes; 0 when the total is unknown (0) and the range is open.
  long Count(long total) const;
};

// "A:B" with both ends included, "A:" to the end, ":B" from the start, "" for all.
Result<FrameRange> ParseFrameRange(const std::string& text);

}  // namespace lorgnette
