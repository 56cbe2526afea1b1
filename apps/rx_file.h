// SPDX-License-Identifier: Apache-2.0
// A prescription file in any of its forms: ours, an HL7 FHIR VisionPrescription, or an OMA job.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "base/result.h"
#include "base/units.h"
#include "optics/prescription.h"

namespace lorgnette {

// FHIR knows no pupillary distance, and a job may lack it: `pd_mm` gives it, in place of the file's
// where that has one too. Without either it is an error.
Result<Prescription> ReadRxFile(const std::string& path,
                                std::optional<double> pd_mm = std::nullopt);

// The fronts of the right and the left lens that an OMA job orders (FRNT), as true powers at
// `index`. None from another file, and none where a job writes less than kLeastOrderedFront_D, as
// some do for want of a value.
Result<std::array<std::optional<Diopters>, 2>> OrderedFronts(const std::string& path, double index);
inline constexpr double kLeastOrderedFront_D = 0.25;

}  // namespace lorgnette
