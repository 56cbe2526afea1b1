// SPDX-License-Identifier: Apache-2.0
#include "optics/long_double_trace.h"
#include "validation/random_lens.h"
#include "validation/worst.h"

namespace lorgnette::validation {
namespace {

void RunV100(CaseRun& run) {
  // Curvatures from 1e-15 to 1/15 mm and none: the centre form of the intersection loses 1e-2 mm at
  // the weak end, the vertex form nothing.
  Worst point;
  Sampler random(100);
  for (int i = 0; i < 20000; ++i) {
    const double c = i % 100 == 0 ? 0 : random.Signed(1e-15, 1 / 15.0);
    const Surface surface = SphereSurface{c};
    const Ray ray = RandomRay(random, 12);
    const auto found = surface.Intersect(ray);
    const auto truth = oracle::Intersect(surface, ray.origin.cast<oracle::Real>(),
                                         ray.direction.cast<oracle::Real>().normalized());
    if (!found || !truth) continue;
    const double distance = ray.origin.norm();
    point.Add(double((found->point.cast<oracle::Real>() - truth->point).norm()) / distance,
              [&] { return fmt::format("curvature {:.3g} per mm", c); });
  }
  point.Report(run, "hit against long double, over the ray's length", "1", 2e-14,
               "a hundred roundings; the direction itself is rounded");
}

}  // namespace

extern const Case kV100;
const Case kV100 = {"V100", "hard", "plano, weak and strong spheres: where a ray meets them",
                    "optics reference section 13, row 1; long double", RunV100};

}  // namespace lorgnette::validation
