// SPDX-License-Identifier: Apache-2.0
#include "validation/magnification_grid.h"
#include "validation/worst.h"

namespace lorgnette::validation {
namespace {

void RunV063(CaseRun& run) {
  // The thick lens goes over into the thin one as its thickness vanishes, linearly.
  Worst limit, slope;
  ForMagnificationGrid([&](const GridPoint& p) {
    if (p.thickness_mm > 2) return;  // the thickness is ours here
    const double thin = ObserverMagnificationThin(Diopters(p.power_D), p.view);
    const auto departure = [&](double thickness_mm) {
      const Lens lens = SpherePairOf(p.power_D, p.front_D, thickness_mm, p.index);
      return ObserverMagnification(SystemOf(lens), thickness_mm, p.view)(0, 0) - thin;
    };
    limit.Add(departure(1e-9), [&] { return p.Where(); });
    slope.Add(departure(1e-3) / departure(2e-3) - 0.5, [&] { return p.Where(); });
  });
  limit.Report(run, "thickness of 1e-9 mm against the thin lens", "1", 1e-9,
               "tau F1 of such a lens is 1e-11, its image up to tenfold as large");
  slope.Report(run, "departure at 1 against that at 2 micrometres, less 1/2", "1", 1e-3,
               "the second order in tau F1, 3e-5, and its cancellation with the first");
}

}  // namespace

extern const Case kV063;
const Case kV063 = {"V063", "magnification", "the thick lens becomes the thin one, linearly",
                    "derived: both formulas of optics reference section 5", RunV063};

}  // namespace lorgnette::validation
