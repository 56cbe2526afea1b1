// SPDX-License-Identifier: Apache-2.0
#include "optics/base_curve.h"
#include "validation/random_lens.h"
#include "validation/worst.h"

namespace lorgnette::validation {
namespace {

void RunV101(CaseRun& run) {
  // A point of the vertex' sheet, and a ray through it: that point has to come back, not the other
  // root, which lies nearer the vertex on steep hyperboloids and vanishes for k = -1 on the axis.
  Worst found, axial;
  Sampler random(101);
  for (int i = 0; i < 20000; ++i) {
    ConicSurface conic;
    conic.curvature = random.Signed(1e-4, 1 / 12.0);
    const double steep[] = {-1, -4, 2};
    conic.conic = i % 4 == 3 ? random.Uniform(-5, 2) : steep[i % 4];
    const Surface surface = conic;
    const double x = random.Uniform(-6, 6), y = random.Uniform(-6, 6);
    const auto jet = surface.Jet(x, y);
    if (!jet) continue;
    const Eigen::Vector3d target(x, y, jet->z);
    const auto where = [&] {
      return fmt::format("k {:.3g}, curvature {:.3g} per mm", conic.conic, conic.curvature);
    };
    // The sheet ends where this is 1; designs stop at kSteepestRimSine. Nearer the end a ray may
    // meet the other sheet first.
    const double end = (1 + conic.conic) * conic.curvature * conic.curvature * (x * x + y * y);
    if (end > kSteepestRimSine * kSteepestRimSine) continue;
    const Eigen::Vector3d slanted =
        Eigen::Vector3d(random.Uniform(-0.4, 0.4), random.Uniform(-0.4, 0.4), 1).normalized();
    for (const Eigen::Vector3d& d : {slanted, Eigen::Vector3d(0, 0, 1)}) {
      const auto hit = surface.Intersect({target - 60 * d, d});
      const double error = hit ? (hit->point - target).norm() : 1e9;
      (d == slanted ? found : axial).Add(error, where);
    }
  }
  found.Report(run, "slanted rays miss their point by", "mm", 1e-12, "roundings over 60 mm");
  axial.Report(run, "axial rays miss their point by", "mm", 1e-12, "roundings over 60 mm");
}

}  // namespace

extern const Case kV101;
const Case kV101 = {"V101", "hard", "steep conics: the root on the sheet of the vertex",
                    "optics reference section 13, row 2 (Optiland #329, #559, #787)", RunV101};

}  // namespace lorgnette::validation
