// SPDX-License-Identifier: Apache-2.0
#include "optics/power_vector.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV021(CaseRun& run) {
  const PowerVector rx = PowerVectorOf({Diopters(-2), Diopters(1.5), AxisDegrees(90)});
  // The base curve is the toric surface's weaker cylinder; the other surface is spherical.
  const SphereCylinder order = MinusCylinderForm(rx);
  const double sphere_surface = order.sphere.value() - (-6);
  run.Exact("spherical surface", "D", 5.5, sphere_surface, 12);
  run.Exact("toric surface, second curve", "D", -7.5, -6 + order.cylinder.value(), 12);
  run.Exact("axis of the second curve", "deg", 180, order.axis.value(), 12);
}

}  // namespace

extern const Case kV021;
const Case kV021 = {"V021", "paraxial", "Thin toric transposition of -2.00 +1.50 x 90 on a -6 base",
                    "mrcophth, mock paper 10", RunV021};

}  // namespace lorgnette::validation
