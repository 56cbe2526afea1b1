// SPDX-License-Identifier: Apache-2.0
// report.json of a try-on (docs/command-line.md explains every key).
#pragma once

#include <string>

#include "apps/tryon_pipeline.h"

namespace lorgnette {

std::string TryonReportJson(const TryonResult& result);

}  // namespace lorgnette
