// SPDX-License-Identifier: Apache-2.0
// A prescription file in any of its forms: ours, an HL7 FHIR VisionPrescription, or an OMA job.
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "optics/prescription.h"

namespace lorgnette {

// FHIR knows no pupillary distance, and a job may lack it: `pd_mm` gives it, in place of the file's
// where that has one too. Without either it is an error.
Result<Prescription> ReadRxFile(const std::string& path,
                                std::optional<double> pd_mm = std::nullopt);

}  // namespace lorgnette
