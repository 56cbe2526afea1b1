// SPDX-License-Identifier: Apache-2.0
// The lenses of a try-on as a job for the lab.
#pragma once

#include "apps/tryon_pipeline.h"
#include "base/result.h"

namespace lorgnette {

// Writes request.oma: the frame's OMA file, else the prescription's, with the results put in and
// everything else kept; a new job where neither is one.
Status WriteOmaJob(const TryonResult& result);

}  // namespace lorgnette
