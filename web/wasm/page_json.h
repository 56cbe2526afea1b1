// SPDX-License-Identifier: Apache-2.0
// Orders and sheets as the page writes and reads them.
#pragma once

#include <string>

#include "base/result.h"
#include "optics/certify.h"
#include "optics/lens_sheet.h"

namespace lorgnette::page {

struct PageOrder {
  LensOrder order;
  SheetRequest request;
};

Result<PageOrder> ReadOrder(const std::string& json_text);
std::string SheetJson(const CertifiedLens& lens, const LensSheet& sheet);
std::string ErrorJson(const Error& error);
std::string PrescriptionJson(const Prescription& prescription);

}  // namespace lorgnette::page
