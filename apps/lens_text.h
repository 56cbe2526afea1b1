// SPDX-License-Identifier: Apache-2.0
// The lens sheet as an optician reads it: one column a lens.
#pragma once

#include <string>
#include <vector>

#include "apps/lens_questions.h"
#include "optics/certify.h"
#include "optics/lens_sheet.h"

namespace lorgnette {

struct SheetColumn {
  const CertifiedLens* lens = nullptr;
  LensSheet sheet;
  const MadeLens* made = nullptr;
  LensLight light;
};

// "-4.25 -0.75 x 160", "-4.50", "plano".
std::string PowerText(const EyePrescription& rx);

std::string LensSheetText(const std::vector<SheetColumn>& columns);

}  // namespace lorgnette
