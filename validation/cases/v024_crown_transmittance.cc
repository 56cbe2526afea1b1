// SPDX-License-Identifier: Apache-2.0
#include "optics/trace.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV024(CaseRun& run) {
  const double r = FresnelReflectance(1, 1 / 1.523);
  run.Rounded("both surfaces once", "%", 91.6, 1, 100 * (1 - r) * (1 - r));
  run.Rounded("all internal bounces", "%", 91.76, 2, 100 * (1 - r) / (1 + r));
  run.Exact("all bounces, closed form", "%", 100 * 2 * 1.523 / (1.523 * 1.523 + 1),
            100 * (1 - r) / (1 + r), 12);
}

}  // namespace

extern const Case kV024;
const Case kV024 = {"V024", "coating",
                    "Transmittance of an uncoated crown lens, single pass and all bounces",
                    "Ellefsen, paperzz 6786699", RunV024};

}  // namespace lorgnette::validation
