// SPDX-License-Identifier: Apache-2.0
// A lens with its ordered prism: by decentration where that can be, by grinding where it must.
#pragma once

#include <Eigen/Core>
#include <string>

#include "base/result.h"
#include "optics/design.h"

namespace lorgnette {

struct PrismDesign {
  LensDesign design;
  // From the optical centre to the point that stands before the pupil; zero where the prism is
  // ground. The design's contour is relative to the optical centre, and so moves the other way.
  Eigen::Vector2d reference_point_mm{0, 0};
  bool decentred = false;
  std::string why_ground;  // why decentration was no way; empty when decentred or without prism
};

// The order's contour (or round outline) lies about the point before the pupil. The prism is exact
// by rays (DecenterForPrism, optics/prism.h), thickness and blank those of the decentred outline,
// solved together with the point. Where no point within `max_decentration_mm` has the prism, it is
// ground (DesignLens). Tested: the prism of the finished lens at the point; plano lenses are
// ground.
Result<PrismDesign> DesignWithPrism(const LensOrder& order, double max_decentration_mm);

}  // namespace lorgnette
