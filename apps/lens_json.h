// SPDX-License-Identifier: Apache-2.0
// Lenses as JSON. The keys are a contract with other programs (docs/command-line.md): keys are
// added, none is renamed. A number that does not exist (a plano radius) is null.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "optics/certify.h"
#include "optics/lens_sheet.h"

namespace lorgnette {

// The number, or null where it is not finite.
nlohmann::ordered_json JsonNumber(double value);

// Order, surfaces, powers, thicknesses, mass and magnification of one lens.
nlohmann::ordered_json LensJson(const LensDesign& design, const LensSheet& sheet);

// What rays measured, each quantity beside what was ordered or predicted.
nlohmann::ordered_json CertificateJson(const Certificate& certificate);

}  // namespace lorgnette
