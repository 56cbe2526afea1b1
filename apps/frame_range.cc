// SPDX-License-Identifier: Apache-2.0
#include "apps/frame_range.h"

#include <algorithm>
#include <charconv>

namespace lorgnette {
namespace {

bool ParseNumber(const std::string& text, long& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end && value >= 0;
}

}  // namespace

long FrameRange::Count(long total) const {
  const bool open = last == std::numeric_limits<long>::max();
  if (total <= 0) return open ? 0 : last - first + 1;
  return std::max(0L, std::min(last, total - 1) - first + 1);
}

Result<FrameRange> ParseFrameRange(const std::string& text) {
  FrameRange range;
  if (text.empty()) return range;
  const std::size_t colon = text.find(':');
  const std::string first = text.substr(0, colon);
  const std::string last = colon == std::string::npos ? "" : text.substr(colon + 1);
  const bool good = colon != std::string::npos &&
                    (first.empty() || ParseNumber(first, range.first)) &&
                    (last.empty() || ParseNumber(last, range.last)) && range.first <= range.last;
  if (!good) {
    return UsageError("--frames: got " + text +
                      ", want A:B with 0 <= A <= B, the first and the last frame");
  }
  return range;
}

}  // namespace lorgnette
