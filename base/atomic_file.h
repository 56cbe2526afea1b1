// SPDX-License-Identifier: Apache-2.0
// A file that appears whole under its final name, or not at all.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

namespace lorgnette {

// A name beside `final_path`, on the same file system, for writing what Commit() then renames.
// The destructor removes the temporary file if it was not committed; what killed processes left of
// theirs for the same name goes with the next one.
class AtomicFile {
 public:
  explicit AtomicFile(std::string final_path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Keeps the extension of the final name (libraries choose formats by it).
  const std::string& temporary_path() const { return temporary_path_; }
  const std::string& final_path() const { return final_path_; }

  // Flushes to disk and renames. Fails with a sentence when the disk is full or the folder is gone.
  Status Commit();

 private:
  std::string final_path_;
  std::string temporary_path_;
  bool committed_ = false;
};

// Writes `content` to `path` through an AtomicFile.
Status WriteFileAtomically(const std::string& path, std::string_view content);

// The whole content of a file; the error names the path and the reason.
Result<std::string> ReadFile(const std::string& path);

}  // namespace lorgnette
