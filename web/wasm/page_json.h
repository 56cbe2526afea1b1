// SPDX-License-Identifier: Apache-2.0
// Orders and sheets as the page writes and reads them.
#pragma once

#include <string>

#include "base/result.h"
#include "optics/certify.h"
#include "optics/fhir.h"
#include "optics/lens_sheet.h"
#include "optics/thin_film.h"

namespace lorgnette::page {

struct PageOrder {
  LensOrder order;
  SheetRequest request;
  CoatKind coat = CoatKind::kNone;  // of both surfaces
  double tint = 0;                  // share of daylight that an even grey dip tint takes
};

Result<PageOrder> ReadOrder(const std::string& json_text);
std::string SheetJson(const CertifiedLens& lens, const LensSheet& sheet, double transmittance);
// In daylight, straight through the centre.
Result<double> Transmittance(const PageOrder& order, double thickness_mm);
std::string ErrorJson(const Error& error);
// PD and vertex distance are null where the source does not say them.
std::string PrescriptionJson(const FhirPrescription& prescription);
std::string FhirJson(const std::string& resource);
std::string MediaJson();

}  // namespace lorgnette::page
