// SPDX-License-Identifier: Apache-2.0
// What a JPEG's EXIF data say of its exposure (CIPA DC-008: tags 0x829A, 0x829D, 0x8827).
#pragma once

#include <optional>
#include <string>

#include "base/result.h"

namespace lorgnette {

struct ExposureTags {
  double time_s = 0;
  double f_number = 1;  // 1 and 100 where the file is silent
  double iso = 100;
};
// nullopt when the file is no JPEG, has no EXIF data, or these name no exposure time.
Result<std::optional<ExposureTags>> ReadExposureTags(const std::string& path);

}  // namespace lorgnette
