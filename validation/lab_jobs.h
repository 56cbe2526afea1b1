// SPDX-License-Identifier: Apache-2.0
// Real job files of lens labs, where they lie on this machine.
#pragma once

#include <string>

#include "base/result.h"
#include "geometry/oma.h"

namespace lorgnette::validation {

// $LORGNETTE_JOBS, else shared/data/oma beside the folder this was built from; with a final slash.
std::string JobFolder();
// Whether it exists.
bool HasJobs();
Result<OmaFile> ReadJob(const std::string& name);

}  // namespace lorgnette::validation
