// SPDX-License-Identifier: Apache-2.0
// HL7 FHIR VisionPrescription, read and written. R4 and R5 have the same elements for spectacles;
// R2 and R3 (`dispense`, scalar prism) are refused by name.
//
// FHIR has no pupillary or vertex distance and no fitting height: they travel as extensions of the
// resource under the URLs below (valueDecimal, mm). Elements of no optical meaning are ignored.
// Source: docs/prescription.md, "FHIR".
#pragma once

#include <string>

#include "base/result.h"
#include "optics/prescription.h"

namespace lorgnette {

inline constexpr char kFhirPdRightUrl[] = "urn:lorgnette:pupillary-distance-right-mm";
inline constexpr char kFhirPdLeftUrl[] = "urn:lorgnette:pupillary-distance-left-mm";
inline constexpr char kFhirVertexUrl[] = "urn:lorgnette:vertex-distance-mm";
inline constexpr char kFhirHeightRightUrl[] = "urn:lorgnette:fitting-height-right-mm";
inline constexpr char kFhirHeightLeftUrl[] = "urn:lorgnette:fitting-height-left-mm";

struct FhirPrescription {
  Prescription rx;
  bool has_pd = false;      // false: rx keeps the default, the caller should ask
  bool has_vertex = false;  // the same
};

// One lensSpecification for each eye, product "lens" (contact lenses are refused). An axis without
// a cylinder, a base that is not up, down, in or out, and a status that voids it are errors.
Result<FhirPrescription> ParseFhir(const std::string& json_text, const std::string& name);
// True for a JSON object that says it is a VisionPrescription.
bool LooksLikeFhir(const std::string& json_text);

// What the resource must say besides the lenses; dates as FHIR writes them (2026-11-22).
struct FhirHeader {
  std::string status = "active";
  std::string created, date_written;
  std::string patient, prescriber;  // references, "Patient/123"
};
// Dioptres with two decimals, trailing zeros kept. FHIR's axis is a whole number: it is rounded.
std::string WriteFhir(const Prescription& rx, const FhirHeader& header);

}  // namespace lorgnette
