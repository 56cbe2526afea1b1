// SPDX-License-Identifier: Apache-2.0
// A soft progressive surface: the addition and corridor of a hard one, with the unwanted
// astigmatism spread over the whole lens instead of piled up beside the corridor.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/result.h"
#include "optics/surface.h"

namespace lorgnette {

// Minimises, over a bicubic spline on the far zone's sphere, the integral of
//   a (cylinder)^2 + b (mean power - wanted)^2
// by Gauss-Newton with the exact surface curvatures. `a` and `b` are largest on the meridian and at
// the far and near reference points; elsewhere the mean power follows the meridian loosely. The
// vertex keeps its place and normal. Source: docs/optics.md, "Soft progressive" (Loos 1998;
// Wang, Gulliver and Santosa). Against the hard surface of the same addition and corridor the worst
// cylinder over a lens of kSoftTestRadius_mm falls by more than kSoftLeastGain.
//   rim_radius_mm  of the lens to be cut; the grid reaches a little farther
Result<Surface> SoftProgressive(const ProgressiveSurface& hard, double index, double rim_radius_mm);

inline constexpr double kSoftLeastGain = 0.25;
inline constexpr double kSoftTestRadius_mm = 25;

// Mean power and unwanted cylinder of a front surface at a point, D.
struct FrontPower {
  double mean = 0, cylinder = 0;
};
// nullopt where the surface has ended.
std::optional<FrontPower> FrontPowerAt(const Surface& surface, double x, double y, double index);

// What a progressive front offers, found on a grid of half millimetres.
struct ProgressiveZones {
  double worst_cylinder_D = 0;   // over a circle of kSoftTestRadius_mm
  double far_width_mm = 0;       // at the vertex's height: cylinder below kClearCylinder_D
  double near_width_mm = 0;      // at the near point's height
  double corridor_width_mm = 0;  // least width between the two
  double addition_D = 0;         // mean power at the near point less that at the vertex
};
inline constexpr double kClearCylinder_D = 0.5;
ProgressiveZones ZonesOf(const Surface& surface, const Eigen::Vector2d& near_point, double index);

}  // namespace lorgnette
