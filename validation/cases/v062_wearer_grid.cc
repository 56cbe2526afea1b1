// SPDX-License-Identifier: Apache-2.0
#include "optics/long_double_trace.h"
#include "validation/magnification_grid.h"
#include "validation/worst.h"

namespace lorgnette::validation {
namespace {

using Real = long double;

// Angle at the entrance pupil over the object's angle, by a long double ray from the pupil outward.
Real WearerByRay(const GridPoint& p) {
  constexpr Real kAngle = 1e-7L;
  const Real pupil = Real(p.thickness_mm) + p.view.depth_mm;
  const oracle::Vec out = oracle::Vec(kAngle, 0, -1).normalized();
  const oracle::Trace ray = oracle::TraceLens(p.lens, oracle::Vec(0, 0, pupil), out, p.index);
  return kAngle / (ray.exit.x() / -ray.exit.z());
}

void RunV062(CaseRun& run) {
  Worst wearer, thin, reciprocity;
  ForMagnificationGrid([&](const GridPoint& p) {
    if (p.view.camera_mm > 300) return;  // no camera here
    const ParaxialSystem system = ParaxialSystem::ThickLens(
        Diopters(p.front_D), Diopters(p.back_D()), p.thickness_mm, p.index);
    const double d = p.view.depth_mm;
    const double library = SpectacleMagnification(system, d);
    wearer.Add(double(library / WearerByRay(p) - 1), [&] { return p.Where(); });
    // Shape times power factor, as the textbooks have it.
    const double product = ShapeFactor(Diopters(p.front_D), p.thickness_mm, p.index) *
                           PowerFactor(system.BackVertexPower(), d);
    thin.Add(product / library - 1, [&] { return p.Where(); });
    // An observer at infinity sees the pupil as large as the wearer sees the world.
    const double far = ObserverParaxial(system, p.thickness_mm, {1e12, d}).magnification;
    reciprocity.Add(far / library - 1, [&] { return p.Where(); });
  });
  wearer.Report(run, "spectacle magnification against long double rays", "1", 1e-11,
                "the square of the ray's angle, 1e-7, times the aberration");
  thin.Report(run, "shape factor times power factor", "1", 1e-13, "a few roundings");
  reciprocity.Report(run, "observer at infinity against the wearer", "1", 1e-9,
                     "1e12 mm for infinity, over the lens' own lengths");
}

}  // namespace

extern const Case kV062;
const Case kV062 = {"V062", "magnification",
                    "the wearer's magnification over the grid, and reciprocity with the observer",
                    "derived: optics reference section 5; rays in long double", RunV062};

}  // namespace lorgnette::validation
