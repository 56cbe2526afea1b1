// SPDX-License-Identifier: Apache-2.0
// Names of numbered image sequences.
#include "render/video_names.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <map>

namespace lorgnette {
namespace {

namespace fs = std::filesystem;

// Position and length of "%d" or "%0Nd" in a file name; npos when it has none, or several.
struct Field {
  std::size_t begin = std::string::npos, length = 0;
  int width = 0;
};

Field FindField(const std::string& name) {
  Field field;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] != '%') continue;
    std::size_t end = i + 1;
    while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end]))) ++end;
    if (end >= name.size() || name[end] != 'd' || end - i > 3) continue;
    if (field.begin != std::string::npos) return {};
    field = {i, end + 1 - i, end > i + 1 ? std::atoi(name.substr(i + 1).c_str()) : 0};
  }
  return field;
}

std::string Numbered(const std::string& name, const Field& field, int number) {
  std::string digits = std::to_string(number);
  if (digits.size() < static_cast<std::size_t>(field.width)) {
    digits.insert(0, static_cast<std::size_t>(field.width) - digits.size(), '0');
  }
  return name.substr(0, field.begin) + digits + name.substr(field.begin + field.length);
}

}  // namespace

bool HasExtension(const std::string& path, const std::vector<std::string>& extensions) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

bool IsSequencePattern(const std::string& path) {
  return FindField(fs::path(path).filename().string()).begin != std::string::npos;
}

std::string SequenceFile(const std::string& pattern, int number) {
  const fs::path path(pattern);
  const std::string name = path.filename().string();
  return (path.parent_path() / Numbered(name, FindField(name), number)).string();
}

Result<Sequence> ListSequence(const std::string& pattern) {
  const fs::path path(pattern);
  const std::string name = path.filename().string();
  const Field field = FindField(name);
  const std::string head = name.substr(0, field.begin);
  const std::string tail = name.substr(field.begin + field.length);
  const fs::path folder = path.parent_path().empty() ? fs::path(".") : path.parent_path();
  std::map<int, std::string> found;
  std::error_code ec;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ec)) {
    const std::string file = entry.path().filename().string();
    if (file.size() <= head.size() + tail.size()) continue;
    const std::string digits = file.substr(head.size(), file.size() - head.size() - tail.size());
    const bool numeric =
        digits.size() < 10 &&
        std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c); });
    if (!numeric) continue;
    const int number = std::atoi(digits.c_str());
    if (Numbered(name, field, number) == file) found[number] = SequenceFile(pattern, number);
  }
  if (ec) return Failure(pattern + ": cannot be read: " + ec.message());
  if (found.empty()) return Failure(pattern + ": no file matches this pattern");
  Sequence sequence;
  sequence.first_number = found.begin()->first;
  int expected = sequence.first_number;
  for (const auto& [number, file] : found) {
    if (number != expected) {
      return Failure(SequenceFile(pattern, expected) +
                     ": is missing in the sequence that goes on to " + found.rbegin()->second);
    }
    sequence.files.push_back(file);
    ++expected;
  }
  return sequence;
}

}  // namespace lorgnette
