// SPDX-License-Identifier: Apache-2.0
// Lenses and gazes as the sources of cases state them.
#pragma once

#include <optional>

#include "base/units.h"
#include "optics/design.h"
#include "optics/gaze.h"
#include "optics/lens.h"

namespace lorgnette::validation {

// Two spheres by their powers, D at `index`.
inline Lens SpherePair(double front_D, double back_D, double thickness_mm, double index) {
  Lens lens;
  lens.front = Surface(SphereSurface{front_D / 1000 / (index - 1)});
  lens.back = Surface(SphereSurface{back_D / 1000 / (1 - index)});
  lens.center_thickness_mm = thickness_mm;
  lens.medium.index_d = index;
  return lens;
}

// The back surface's power that gives the lens its exact back vertex power.
inline double BackPowerFor(double power_D, double front_D, double thickness_mm, double index) {
  return power_D - front_D / (1 - thickness_mm / 1000 / index * front_D);
}
inline Lens SpherePairOf(double power_D, double front_D, double thickness_mm, double index) {
  return SpherePair(front_D, BackPowerFor(power_D, front_D, thickness_mm, index), thickness_mm,
                    index);
}

// An eye turned by theta in the horizontal plane, its centre `stop_mm` behind the back vertex.
inline GazeVergence GazeAt(const Lens& lens, double theta_deg, double stop_mm = 27) {
  return EvaluateGaze(lens, lens.medium.index_d, EyePose::OnAxis(lens, stop_mm),
                      {RadiansFromDegrees(theta_deg), 0});
}

// A round lens, thickness by the program's rule when absent: 1 mm at the centre or the edge.
inline Result<LensDesign> RoundDesign(double power_D, double index, double front_D,
                                      double diameter_mm,
                                      std::optional<double> thickness_mm = std::nullopt) {
  LensOrder order;
  order.rx.sphere = Diopters(power_D);
  order.medium.index_d = index;
  order.medium.density_g_cm3 = 1.30;
  order.base_curve = Diopters(front_D);
  order.diameter_mm = diameter_mm;
  order.center_thickness_mm = thickness_mm;
  order.min_center_thickness_mm = 1;
  return DesignLens(order);
}

}  // namespace lorgnette::validation
