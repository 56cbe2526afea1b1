// SPDX-License-Identifier: Apache-2.0
// Which validation cases back a line of a lens' certificate.
#pragma once

#include <string>
#include <vector>

namespace lorgnette::validation {

// Ids of the cases that verify how this quantity (optics/certify.h) is computed and measured; by
// the words the quantity begins with. Empty for a quantity that is not known.
// Tested: every quantity of every kind of certificate has some, and every id is a case.
std::vector<std::string> CasesBacking(const std::string& quantity);

}  // namespace lorgnette::validation
