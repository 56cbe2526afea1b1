// SPDX-License-Identifier: Apache-2.0
// Multifocal fronts: what an order says of them, and the surfaces that come of it.
#pragma once

#include "base/result.h"
#include "base/units.h"
#include "optics/surface.h"

namespace lorgnette {

enum class Eye { kRight, kLeft };

// +1 where the nose lies on the side of the lens frame's +x, that is for the left eye.
inline double NasalSign(Eye eye) { return eye == Eye::kLeft ? 1 : -1; }

enum class SegmentShape { kRound, kFlatTop, kExecutive };

// A bifocal segment on the front. Lengths in mm from the optical centre of the distance portion.
struct SegmentOrder {
  SegmentShape shape = SegmentShape::kFlatTop;
  double width_mm = 28;  // 22 or 24 round, 28 or 35 flat-topped; of no meaning for the executive
  double top_mm = -4;    // height of the segment's top
  double inset_mm = 2;   // of its middle, toward the nose
};
// Distance of the segment's own optical centre below its top: the radius of a round one,
// kFlatTopDrop_mm of a flat-topped one, 0 of the executive.
inline constexpr double kFlatTopDrop_mm = 5;
double SegmentDrop_mm(const SegmentOrder& segment);
// Image jump at the top, prism dioptres: addition times the drop in cm.
PrismDiopters ImageJump(const SegmentOrder& segment, Diopters add);

enum class ProgressiveDesign { kHard, kSoft };

// A progressive front: power rises from `start_mm` over `corridor_mm` down to the full addition.
struct ProgressiveOrder {
  ProgressiveDesign design = ProgressiveDesign::kHard;
  double start_mm = -2;     // top of the corridor, at or below the optical centre
  double corridor_mm = 14;  // to 100 per cent of the addition
  double inset_mm = 2.5;    // of the near point, toward the nose
};
// Where the full addition is first reached, lens frame.
Eigen::Vector2d NearPoint(const ProgressiveOrder& progressive, Eye eye);

// Front surfaces of a given base curve (true power at `index`).
Result<Surface> SegmentFront(const SegmentOrder& segment, Eye eye, Diopters base, Diopters add,
                             double index);
Result<Surface> ProgressiveFront(const ProgressiveOrder& progressive, Eye eye, Diopters base,
                                 Diopters add, double index, double rim_radius_mm);

// Base-down prism that labs grind into both progressive lenses to thin them: two thirds of the
// addition, the same before both eyes so that it unbalances nothing.
PrismDiopters ThinningPrismDown(Diopters add);

}  // namespace lorgnette
