// SPDX-License-Identifier: Apache-2.0
// File names of videos and of numbered image sequences. Private to render/.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"

namespace lorgnette {

// Extensions in lower case with their point; the path's may be in capitals.
bool HasExtension(const std::string& path, const std::vector<std::string>& extensions);
// The pattern's file for one number: "shot_%04d.png" and 7 give "shot_0007.png". A pattern has
// exactly one %d or %0Nd in its file name.
bool IsSequencePattern(const std::string& path);
std::string SequenceFile(const std::string& pattern, int number);
// Existing files of the pattern, in order; an error when there are none, or a gap.
struct Sequence {
  int first_number = 0;
  std::vector<std::string> files;
};
Result<Sequence> ListSequence(const std::string& pattern);

}  // namespace lorgnette
