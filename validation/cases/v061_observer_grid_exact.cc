// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "optics/long_double_trace.h"
#include "validation/magnification_grid.h"
#include "validation/worst.h"

namespace lorgnette::validation {
namespace {

void RunV061(CaseRun& run) {
  // The library finds the camera ray that reaches a feature; a long double trace of that very ray
  // has to meet the feature. What it misses by is the error of the height.
  Worst miss, axis;
  long lost = 0, counted = 0;
  ForMagnificationGrid([&](const GridPoint& p) {
    for (const double height : {0.001, 2.0, 5.85, 12.0}) {
      const auto ray = ObserverExact(p.lens, p.index, p.view, {height, 0});
      // A back surface of 24 mm radius ends before 12 mm do at the strongest powers.
      if (!ray) {
        ++lost;
        continue;
      }
      ++counted;
      const oracle::Vec direction =
          oracle::Vec(ray->camera_tangent.x(), ray->camera_tangent.y(), 1).normalized();
      const oracle::Trace trace =
          oracle::TraceLens(p.lens, oracle::Vec(0, 0, -p.view.camera_mm), direction, p.index);
      const oracle::Real plane = oracle::Real(p.thickness_mm) + p.view.depth_mm;
      const oracle::Real hit = trace.second.point.x() +
                               (plane - trace.second.point.z()) / trace.exit.z() * trace.exit.x();
      miss.Add(double(hit - height) / double(p.view.camera_mm + plane),
               [&] { return fmt::format("{}, height {} mm", p.Where(), height); });
      if (height < 0.01) {
        const double first_order =
            ObserverMagnification(SystemOf(p.lens), p.thickness_mm, p.view)(0, 0);
        axis.Add(ray->magnification / first_order - 1, [&] { return p.Where(); });
      }
    }
  });
  miss.Report(run, "what the exact ray misses its feature by, over the distance", "1", 1e-13,
              "the search stops at 16 roundings of the distance");
  axis.Report(run, "exact ray near the axis against first order", "1", 1e-6,
              "the square of a micrometre over the radii, and of its image where that is large");
  run.Bound("share of features that no ray reaches", "1", double(lost) / double(lost + counted),
            0.1, "surfaces that end, at the strongest powers only");
}

}  // namespace

extern const Case kV061;
const Case kV061 = {"V061", "magnification",
                    "the observer's magnification by exact rays, heights to 12 mm, over the grid",
                    "long double rays, written apart from the library", RunV061};

}  // namespace lorgnette::validation
