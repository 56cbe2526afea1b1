// SPDX-License-Identifier: Apache-2.0
#include "optics/front_form.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV023(CaseRun& run) {
  const auto jump = [](SegmentShape shape, double diameter) {
    SegmentOrder segment;
    segment.shape = shape;
    segment.width_mm = diameter;
    return ImageJump(segment, Diopters(2)).value();
  };
  run.Exact("round 22", "prism D", 2.2, jump(SegmentShape::kRound, 22), 12);
  run.Exact("round 24", "prism D", 2.4, jump(SegmentShape::kRound, 24), 12);
  run.Exact("flat-top 28", "prism D", 1.0, jump(SegmentShape::kFlatTop, 28), 12);
}

}  // namespace

extern const Case kV023;
const Case kV023 = {"V023", "multifocal",
                    "Image jump of a 2.00 D addition: round 22 and 24 mm, flat-top 28",
                    "Durham Technical Community College; Bhootra", RunV023};

}  // namespace lorgnette::validation
