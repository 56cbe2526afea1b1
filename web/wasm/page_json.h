// SPDX-License-Identifier: Apache-2.0
// Orders and sheets as the page writes and reads them.
#pragma once

#include <string>

#include "base/result.h"
#include "optics/certify.h"
#include "optics/fhir.h"
#include "optics/lens_sheet.h"
#include "optics/thin_film.h"
#include "optics/wear.h"

namespace lorgnette::page {

struct PageOrder {
  LensOrder order;
  SheetRequest request;
  CoatKind coat = CoatKind::kNone;  // of both surfaces
  double tint = 0;                  // share of daylight that an even grey dip tint takes
  WearPosition wear;
  double refraction_vertex_mm = 13;  // at which the prescription was found, straight before the eye
  bool compensate = false;           // the lens is made so that, as worn, it does what `rx` asks
};

Result<PageOrder> ReadOrder(const std::string& json_text);

struct PageSheet {
  LensSheet sheet;
  double transmittance = 1;
  PowerVector target;  // what the eye is to meet at the back vertex as worn
  WornPower worn;      // what it meets there, by rays
};
std::string SheetJson(const CertifiedLens& lens, const PageOrder& page, const PageSheet& sheet);
// In daylight, straight through the centre.
Result<double> Transmittance(const PageOrder& order, double thickness_mm);
std::string ErrorJson(const Error& error);
// PD and vertex distance are null where the source does not say them.
std::string PrescriptionJson(const FhirPrescription& prescription);
std::string FhirJson(const std::string& resource);
std::string MediaJson();

}  // namespace lorgnette::page
