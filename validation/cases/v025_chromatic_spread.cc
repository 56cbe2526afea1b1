// SPDX-License-Identifier: Apache-2.0
#include "optics/design.h"
#include "optics/media.h"
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV025(CaseRun& run) {
  // Design at d, power at F and C by the same surfaces.
  LensOrder order;
  order.rx.sphere = Diopters(6);
  order.medium.index_d = 1.586;
  order.medium.abbe = 30;
  order.diameter_mm = 50;
  const auto design = DesignLens(order);
  if (!design) return;
  const auto power = [&](double wavelength_nm) {
    return SystemOf(design->lens, IndexAt(design->lens.medium, wavelength_nm))
        .BackVertexPower()(0, 0);
  };
  // F / V is the spread of a thin lens; thickness changes it in the second digit after the point.
  run.Rounded("spread", "D", 0.2, 1, power(486.1327) - power(656.2725));
}

}  // namespace

extern const Case kV025;
const Case kV025 = {"V025", "coating",
                    "Longitudinal spread of a +6.00 D lens between the F and C lines, V = 30",
                    "2020mag, chromatic aberration (low authority)", RunV025};

}  // namespace lorgnette::validation
