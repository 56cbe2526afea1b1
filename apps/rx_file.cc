// SPDX-License-Identifier: Apache-2.0
#include "apps/rx_file.h"

#include <fmt/format.h>

#include <cmath>

#include "base/atomic_file.h"
#include "geometry/oma.h"
#include "optics/base_curve.h"
#include "optics/fhir.h"

namespace lorgnette {

Result<Prescription> ReadRxFile(const std::string& path, std::optional<double> pd_mm) {
  if (pd_mm && !(*pd_mm >= kMinPd_mm && *pd_mm <= kMaxPd_mm)) {
    return UsageError(fmt::format("--pd: got {}, want {}..{}", *pd_mm, kMinPd_mm, kMaxPd_mm));
  }
  LG_ASSIGN(const std::string text, ReadFile(path));
  Prescription rx;
  if (IsOmaPath(path)) {
    LG_ASSIGN(const OmaFile job, OmaFile::Parse(text, path));
    LG_ASSIGN(const OmaOrder order, ReadOmaOrder(job));
    if (!order.has_pd && !pd_mm) {
      return UsageError(path + ":IPD: got no pupillary distance, want --pd");
    }
    rx = order.rx;
  } else if (LooksLikeFhir(text)) {
    LG_ASSIGN(const FhirPrescription fhir, ParseFhir(text, path));
    if (!fhir.has_pd && !pd_mm) {
      return UsageError(path + ": FHIR says no pupillary distance, want --pd");
    }
    rx = fhir.rx;
  } else {
    LG_ASSIGN(rx, ParsePrescription(text, path));
  }
  if (pd_mm) rx.pd_right_mm = rx.pd_left_mm = *pd_mm / 2;
  return rx;
}

Result<std::array<std::optional<Diopters>, 2>> OrderedFronts(const std::string& path,
                                                             double index) {
  std::array<std::optional<Diopters>, 2> fronts;
  if (!IsOmaPath(path)) return fronts;
  LG_ASSIGN(const std::string text, ReadFile(path));
  LG_ASSIGN(const OmaFile job, OmaFile::Parse(text, path));
  LG_ASSIGN(const OmaOrder order, ReadOmaOrder(job));
  const std::optional<double> written[] = {order.front_diopters.right, order.front_diopters.left};
  for (std::size_t eye = 0; eye < fronts.size(); ++eye) {
    if (!written[eye] || std::abs(*written[eye]) < kLeastOrderedFront_D) continue;
    fronts[eye] = ToolPower(Diopters(*written[eye]), kToolIndex, index);
  }
  return fronts;
}

}  // namespace lorgnette
