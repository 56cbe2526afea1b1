// SPDX-License-Identifier: Apache-2.0
// Words and numbers of a line of text.
#pragma once

#include <algorithm>
#include <charconv>
#include <string_view>

namespace lorgnette {

// Splits off the next word between blanks; empty at the end of the line.
inline std::string_view NextWord(std::string_view& line) {
  const std::size_t start = line.find_first_not_of(" \t\r");
  if (start == std::string_view::npos) return line = {};
  line.remove_prefix(start);
  const std::size_t end = std::min(line.find_first_of(" \t\r"), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

// The whole word as a number; a plus sign is allowed.
inline bool ReadDouble(std::string_view word, double& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

// The rest of a line without blanks at its ends: a name that may hold some.
inline std::string_view RestOf(std::string_view line) {
  const std::size_t start = line.find_first_not_of(" \t\r");
  if (start == std::string_view::npos) return {};
  return line.substr(start, line.find_last_not_of(" \t\r") + 1 - start);
}

}  // namespace lorgnette
