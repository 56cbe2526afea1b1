// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "optics/design.h"
#include "optics/gaze.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV044(CaseRun& run) {
  // The source measures the axis as a mathematical angle, here the lens frame's: TABO 180 - A.
  LensOrder order;
  order.rx = {Diopters(-4), Diopters(-3), AxisDegrees(150), {}, {}, {}};
  order.medium.index_d = 1.6;
  order.base_curve = Diopters(4);
  order.center_thickness_mm = 1.5;
  const auto toric = DesignLens(order);
  order.generator = ToricGenerator::kAlongMinusAxis;
  const auto other = DesignLens(order);
  if (!toric || !other) return;
  const auto gaze = [&](const Lens& lens, double theta, double phi, double sphere, double cylinder,
                        double axis) {
    const SphereCylinder power = EvaluateGaze(lens, 1.6, EyePose::OnAxis(lens, 27),
                                              {RadiansFromDegrees(theta), RadiansFromDegrees(phi)})
                                     .power;
    const std::string name =
        "(" + std::to_string(int(theta)) + ", " + std::to_string(int(phi)) + ") ";
    run.Rounded(name + "S'", "D", sphere, 6, power.sphere.value());
    run.Rounded(name + "C'", "D", cylinder, 6, power.cylinder.value());
    run.Rounded(name + "A'", "deg", axis, 5, 180 - power.axis.value());
  };
  gaze(toric->lens, 20, 45, -4.062194, -2.916665, 29.60786);
  gaze(toric->lens, 30, 0, -4.002467, -2.904593, 31.09722);
  gaze(toric->lens, 30, 90, -3.773999, -3.071410, 29.04821);
  gaze(toric->lens, 30, 135, -3.694691, -3.125294, 30.52178);
  gaze(other->lens, 20, 45, -4.064269, -2.946910, 29.26745);
}

}  // namespace

extern const Case kV044;
const Case kV044 = {"V044", "programs", "C4: a toric lens at four gazes, in Listing-rotated axes",
                    "derived with 30 digits; confirmed by Optiland to 8 digits", RunV044};

}  // namespace lorgnette::validation
