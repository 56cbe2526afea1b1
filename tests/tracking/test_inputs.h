// SPDX-License-Identifier: Apache-2.0
// Files that a test needs and a machine may lack; NEED skips it there.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cmake/source_dir.h"

namespace lorgnette::test {

inline const std::string kModels = LORGNETTE_SOURCE_DIR "/cache/models";
inline const std::string kTruth = LORGNETTE_SOURCE_DIR "/../shared/data/groundtruth";

}  // namespace lorgnette::test

#define NEED(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs " << (path)
