// SPDX-License-Identifier: Apache-2.0
// A prescription file in either of its forms: ours, or an HL7 FHIR VisionPrescription.
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "optics/prescription.h"

namespace lorgnette {

// FHIR knows no pupillary distance: `pd_mm` gives it, in place of the file's where that has one
// too. Without either it is an error.
Result<Prescription> ReadRxFile(const std::string& path,
                                std::optional<double> pd_mm = std::nullopt);

}  // namespace lorgnette
