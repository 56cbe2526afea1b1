// SPDX-License-Identifier: Apache-2.0
// What two lenses are to each other: imbalance, slab-off, equal magnification.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "apps/lens_orders.h"
#include "optics/iseikonic.h"

namespace lorgnette {

// Base curves and thicknesses with which both lenses magnify alike (right over left: `ratio`), set
// in the orders. Astigmatic lenses count with their mean power. The pupil stands at each order's
// vertex distance + kEntrancePupilDepth_mm.
struct Iseikonic {
  IseikonicPair pair;
  double ratio_wanted = 1;
};
Result<Iseikonic> MakeIseikonic(const std::vector<MadeLens>& lenses, double ratio,
                                std::vector<LensOrder>& orders);

// Right lens first. `reading_drop_mm`: both eyes look this far below the optical centres.
nlohmann::ordered_json PairJson(const std::vector<MadeLens>& lenses, double reading_drop_mm,
                                const std::optional<Iseikonic>& iseikonic);
std::string PairText(const std::vector<MadeLens>& lenses, double reading_drop_mm,
                     const std::optional<Iseikonic>& iseikonic);

}  // namespace lorgnette
