// SPDX-License-Identifier: Apache-2.0
#include "optics/front_form.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "optics/soft_progressive.h"

namespace lorgnette {

double SegmentDrop_mm(const SegmentOrder& segment) {
  switch (segment.shape) {
    case SegmentShape::kRound:
      return segment.width_mm / 2;
    case SegmentShape::kFlatTop:
      return kFlatTopDrop_mm;
    case SegmentShape::kExecutive:
      break;
  }
  return 0;
}

PrismDiopters ImageJump(const SegmentOrder& segment, Diopters add) {
  return PrismDiopters(add.value() * SegmentDrop_mm(segment) / 10);
}

Eigen::Vector2d NearPoint(const ProgressiveOrder& progressive, Eye eye) {
  return {NasalSign(eye) * progressive.inset_mm, progressive.start_mm - progressive.corridor_mm};
}

PrismDiopters ThinningPrismDown(Diopters add) { return PrismDiopters(2 * add.value() / 3); }

Result<Surface> SegmentFront(const SegmentOrder& segment, Eye eye, Diopters base, Diopters add,
                             double index) {
  BifocalSurface s;
  s.curvature = base.per_mm() / (index - 1);
  s.curvature_segment = (base + add).per_mm() / (index - 1);
  const double drop = SegmentDrop_mm(segment);
  s.center = {NasalSign(eye) * segment.inset_mm, segment.top_mm - drop};
  s.top = drop;
  s.radius = segment.shape == SegmentShape::kExecutive ? 0 : segment.width_mm / 2;
  const double reach = s.center.norm() + s.radius;
  const double steepest = std::max(std::abs(s.curvature), std::abs(s.curvature_segment));
  if (steepest * reach >= 1) {
    return Failure(fmt::format(
        "lens: the segment reaches {:.1f} mm from the optical centre, where a front of {:+.2f} D "
        "has no real sag; possible: up to {:.1f} mm, or a flatter base curve",
        reach, (base + add).value(), 1 / steepest));
  }
  if (segment.shape == SegmentShape::kFlatTop && s.radius <= drop) {
    return UsageError(
        fmt::format("lens order: segment width: got {} mm, want more than {} for a "
                    "flat top",
                    segment.width_mm, 2 * drop));
  }
  return Surface(s);
}

Result<Surface> ProgressiveFront(const ProgressiveOrder& progressive, Eye eye, Diopters base,
                                 Diopters add, double index, double rim_radius_mm) {
  if (!(progressive.corridor_mm >= 4 && progressive.corridor_mm <= 30)) {
    return UsageError(
        fmt::format("lens order: corridor: got {} mm, want 4..30", progressive.corridor_mm));
  }
  if (!(progressive.start_mm <= 0 && progressive.start_mm >= -15)) {
    return UsageError(
        fmt::format("lens order: corridor's start: got {} mm, want -15..0", progressive.start_mm));
  }
  const Eigen::Vector2d near = NearPoint(progressive, eye);
  // The lower end of the meridian leans toward the nose.
  const double angle = std::atan2(near.x(), -near.y());
  const double length = near.norm() * progressive.corridor_mm / -near.y();
  const ProgressiveSurface hard(base.per_mm() / (index - 1), add.per_mm() / (index - 1),
                                progressive.start_mm * length / progressive.corridor_mm, length,
                                angle);
  if (progressive.design == ProgressiveDesign::kHard) return Surface(hard);
  return SoftProgressive(hard, index, rim_radius_mm);
}

}  // namespace lorgnette
