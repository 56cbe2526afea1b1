// SPDX-License-Identifier: Apache-2.0
#include "optics/power_vector.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV019(CaseRun& run) {
  const PowerVector a = PowerVectorOf({Diopters(0), Diopters(2), AxisDegrees(120)});
  const PowerVector b = PowerVectorOf({Diopters(0), Diopters(-2.25), AxisDegrees(30)});
  const SphereCylinder sum = MinusCylinderForm({a.mean + b.mean, a.j0 + b.j0, a.j45 + b.j45});
  run.Exact("sphere", "D", 2, sum.sphere.value(), 12);
  run.Exact("cylinder", "D", -4.25, sum.cylinder.value(), 12);
  run.Exact("axis", "deg", 30, sum.axis.value(), 12);
}

}  // namespace

extern const Case kV019;
const Case kV019 = {"V019", "paraxial", "+2.00 x 120 with -2.25 x 30 as one sphero-cylinder",
                    "studentdoctor forum 117 answer key", RunV019};

}  // namespace lorgnette::validation
