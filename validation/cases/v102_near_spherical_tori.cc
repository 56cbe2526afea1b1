// SPDX-License-Identifier: Apache-2.0
#include "optics/long_double_trace.h"
#include "validation/random_lens.h"
#include "validation/worst.h"

namespace lorgnette::validation {
namespace {

void RunV102(CaseRun& run) {
  Sampler random(102);
  struct Radii {
    double generator, across;
  };
  for (const Radii& r :
       {Radii{60, 60.01}, Radii{60, 60 + 1e-7}, Radii{1e6, 75}, Radii{60, 90}, Radii{-80, 50}}) {
    const Surface surface = TorusSurface{1 / r.generator, 1 / r.across, 0.7};
    Worst point;
    for (int i = 0; i < 2000; ++i) {
      const Ray ray = RandomRay(random, 20);
      const auto found = surface.Intersect(ray);
      const auto truth = oracle::Intersect(surface, ray.origin.cast<oracle::Real>(),
                                           ray.direction.cast<oracle::Real>().normalized());
      if (!found || !truth) continue;
      point.Add(
          double((found->point.cast<oracle::Real>() - truth->point).norm()) / ray.origin.norm(),
          [&] { return fmt::format("({:.1f}, {:.1f})", found->point.x(), found->point.y()); });
    }
    point.Report(run,
                 fmt::format("radii {:.10g} and {:.10g} mm: hit over the ray's length", r.generator,
                             r.across),
                 "1", 2e-14, "a hundred roundings; a quartic's roots err by 1e-7 here");
  }
}

}  // namespace

extern const Case kV102;
const Case kV102 = {"V102", "hard", "tori that are almost spheres or cylinders",
                    "optics reference section 13, row 4 (Optiland #151, #239)", RunV102};

}  // namespace lorgnette::validation
