// SPDX-License-Identifier: Apache-2.0
// The lenses that the page has designed.
#pragma once

#include "optics/lens.h"

namespace lorgnette::page {

// nullptr for a slot that holds nothing yet, and for no slot of ours.
const Lens* LensIn(int slot);

}  // namespace lorgnette::page
