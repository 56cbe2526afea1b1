// SPDX-License-Identifier: Apache-2.0
#include "optics/power_vector.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV020(CaseRun& run) {
  const PowerVector rx = PowerVectorOf({Diopters(3), Diopters(-1), AxisDegrees(180)});
  // The base curve is the toric surface's weaker cylinder; the other surface is spherical.
  const SphereCylinder order = PlusCylinderForm(rx);
  const double sphere_surface = order.sphere.value() - (6);
  run.Exact("spherical surface", "D", -4, sphere_surface, 12);
  run.Exact("toric surface, second curve", "D", 7, 6 + order.cylinder.value(), 12);
  run.Exact("axis of the second curve", "deg", 90, order.axis.value(), 12);
}

}  // namespace

extern const Case kV020;
const Case kV020 = {"V020", "paraxial",
                    "Thin toric transposition of +3.00 -1.00 x 180 on a +6 base",
                    "mrcophth, mock paper 10", RunV020};

}  // namespace lorgnette::validation
