// SPDX-License-Identifier: Apache-2.0
#include "optics/magnification.h"
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV043(CaseRun& run) {
  // Design by the exact back vertex power, then the observer's view.
  const auto view = [](double power, double index, double thickness, double f1, double depth,
                       double camera) {
    const double tau = thickness / 1000 / index;
    const Diopters f2(power - f1 / (1 - tau * f1));
    return ObserverParaxial(ParaxialSystem::ThickLens(Diopters(f1), f2, thickness, index),
                            thickness, {camera, depth});
  };
  const ObserverView minus_six = view(-6, 1.6, 1.5, 2, 15.05, 500);
  run.Exact("-6: magnification", "1", 0.922034866926002, minus_six.magnification, 12);
  run.Exact("-6: lateral", "1", 0.9189016988252588, minus_six.lateral, 12);
  run.Exact("-6: image depth behind the front vertex", "mm", 14.7947106498,
            minus_six.apparent_depth_mm, 11);
  const ObserverView plus_six = view(6, 1.6, 5, 9, 15.05, 500);
  run.Exact("+6: magnification", "1", 1.129596368684965, plus_six.magnification, 12);
  run.Exact("+6: lateral", "1", 1.131074977192933, plus_six.lateral, 12);
  run.Exact("+6: image depth behind the front vertex", "mm", 20.7307301934,
            plus_six.apparent_depth_mm, 11);
  run.Exact("-12: magnification", "1", 0.8514726728034432,
            view(-12, 1.74, 1.2, 1, 15.05, 600).magnification, 12);
}

}  // namespace

extern const Case kV043;
const Case kV043 = {"V043", "magnification",
                    "C3: what an observer sees of the iris behind -6, +6 and -12 D",
                    "reference section 14, recomputed with 40 digits", RunV043};

}  // namespace lorgnette::validation
