// SPDX-License-Identifier: Apache-2.0
#include "validation/lab_jobs.h"

#include <cstdlib>
#include <filesystem>

#include "base/atomic_file.h"
#include "cmake/source_dir.h"

namespace lorgnette::validation {

std::string JobFolder() {
  const char* own = std::getenv("LORGNETTE_JOBS");
  return (own != nullptr ? std::string(own) : LORGNETTE_SOURCE_DIR "/../shared/data/oma") + "/";
}

bool HasJobs() {
  std::error_code ec;
  return std::filesystem::exists(JobFolder() + "STHKFMT.oma", ec);
}

Result<OmaFile> ReadJob(const std::string& name) {
  LG_ASSIGN(const std::string bytes, ReadFile(JobFolder() + name));
  return OmaFile::Parse(bytes, name);
}

}  // namespace lorgnette::validation
