// SPDX-License-Identifier: Apache-2.0
// The grid of lenses and views over which magnification is verified: power -20 to +20 D, index,
// base curve, thickness, depth of the feature and distance of the camera.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "optics/magnification.h"
#include "validation/made_lens.h"

namespace lorgnette::validation {

struct GridPoint {
  double power_D, index, front_D, thickness_mm;
  ObserverGeometry view;
  Lens lens;

  double back_D() const { return BackPowerFor(power_D, front_D, thickness_mm, index); }
  std::string Where() const {
    return fmt::format("{:+g} D, n {}, F1 {:+g}, t {} mm, depth {} mm, camera {} mm", power_D,
                       index, front_D, thickness_mm, view.depth_mm, view.camera_mm);
  }
};

// visit(point) for each of 11 x 3 x 3 x 2 x 3 x 3 combinations; the base curve moves with the power
// as real ones do (plus lenses are steeper in front).
template <typename Visit>
void ForMagnificationGrid(Visit&& visit) {
  for (double power = -20; power <= 20; power += 4) {
    for (const double index : {1.5, 1.6, 1.74}) {
      for (const double bend : {-2.0, 0.0, 3.0}) {
        const double front = std::max(0.5, (power > 0 ? power + 4 : power / 4 + 5) + bend);
        for (const double thickness : {1.5, 7.0}) {
          for (const double depth : {12.0, 15.05, 28.0}) {
            for (const double camera : {250.0, 600.0, 3000.0}) {
              visit(GridPoint{power,
                              index,
                              front,
                              thickness,
                              {camera, depth},
                              SpherePairOf(power, front, thickness, index)});
            }
          }
        }
      }
    }
  }
}

}  // namespace lorgnette::validation
