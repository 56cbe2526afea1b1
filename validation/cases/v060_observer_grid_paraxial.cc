// SPDX-License-Identifier: Apache-2.0
#include "optics/long_double_trace.h"
#include "validation/magnification_grid.h"
#include "validation/worst.h"

namespace lorgnette::validation {
namespace {

using Real = long double;

// (L + t + z) / J, J = L (1 - tau F1) + tau + z [(1 - tau F2) - L Fe], in metres, from the radii.
Real ClosedForm(const GridPoint& p) {
  const Real f1 = p.front_D, n = p.index, t = Real(p.thickness_mm) / 1000, tau = t / n;
  const Real camera = Real(p.view.camera_mm) / 1000, z = Real(p.view.depth_mm) / 1000;
  // The back power that the lens has, not the one that was asked for.
  const Real f2 = (1 - n) * 1000 * std::get<SphereSurface>(p.lens.back.shape()).curvature;
  const Real fe = f1 + f2 - tau * f1 * f2;
  return (camera + t + z) / (camera * (1 - tau * f1) + tau + z * ((1 - tau * f2) - camera * fe));
}

// The same by two long double rays a hair apart from the axis: the slope at height 0.
Real ObserverByRay(const GridPoint& p) {
  constexpr Real kAngle = 1e-7L;
  const oracle::Vec direction = oracle::Vec(kAngle, 0, 1).normalized();
  const oracle::Trace ray =
      oracle::TraceLens(p.lens, oracle::Vec(0, 0, -p.view.camera_mm), direction, p.index);
  const Real plane = Real(p.thickness_mm) + p.view.depth_mm;
  const Real height =
      ray.second.point.x() + (plane - ray.second.point.z()) / ray.exit.z() * ray.exit.x();
  return kAngle * (Real(p.view.camera_mm) + plane) / height;
}

void RunV060(CaseRun& run) {
  Worst library, rays;
  ForMagnificationGrid([&](const GridPoint& p) {
    const Real truth = ClosedForm(p);
    const ObserverView view =
        ObserverParaxial(ParaxialSystem::ThickLens(Diopters(p.front_D), Diopters(p.back_D()),
                                                   p.thickness_mm, p.index),
                         p.thickness_mm, p.view);
    library.Add(double(view.magnification / truth - 1), [&] { return p.Where(); });
    rays.Add(double(ObserverByRay(p) / truth - 1), [&] { return p.Where(); });
  });
  library.Report(run, "thick lens to first order against the closed form", "1", 1e-13,
                 "roundings of doubles, tenfold where the lens images the feature far away");
  rays.Report(run, "long double rays at 1e-7 rad against the closed form", "1", 1e-9,
              "the square of the ray's height over the radii, (3e-4 / 20)^2, and of its image");
}

}  // namespace

extern const Case kV060;
const Case kV060 = {"V060", "magnification",
                    "the observer's magnification over a grid of lenses, to first order",
                    "derived: optics reference section 5; rays in long double", RunV060};

}  // namespace lorgnette::validation
