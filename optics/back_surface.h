// SPDX-License-Identifier: Apache-2.0
// The back curve that gives a lens its power, exactly: behind any front, with or without prism.
#pragma once

#include <Eigen/Core>

#include "optics/lens.h"
#include "optics/surface.h"

namespace lorgnette {

// Which principal circle of a toric back generates it (docs/optics.md, "Surfaces"): the one across
// the minus-cylinder axis, which is the more strongly curved, or the one along it.
enum class ToricGenerator { kAcrossMinusAxis, kAlongMinusAxis };

// Turn of the back surface about its vertex that deviates an axial ray by a given prism.
struct GroundPrism {
  double tilt_x = 0, tilt_y = 0;  // Lens::back_tilt_*
  double incidence = 0;           // of the axial ray on the back surface, inside, radians
  double deviation = 0;           // radians
  Eigen::Vector2d toward{1, 0};   // unit, lens frame: the base
};
// prism  prism dioptres in the lens frame's x, y, toward the base; zero gives zero tilt.
GroundPrism GrindPrism(const Eigen::Vector2d& prism, double index);

// Vertex curvature of the back surface, in its own (tilted) axes, 1/mm, such that an axial parallel
// pencil leaves with the vergence matrix `power_D` at the back vertex, in the plane across the
// leaving ray. Without prism this is F2 = F'v - F1 (I - tau F1)^-1; with prism the pencil meets the
// surface obliquely and the generalised Coddington equation is solved for the curvature.
//   front_D  power matrix of the front surface, lens frame
Eigen::Matrix2d BackCurvature(const Eigen::Matrix2d& front_D, const Eigen::Matrix2d& power_D,
                              double thickness_mm, double index, const GroundPrism& prism);

// The same by the paper's equation (1), F2 = F'v - F1 - tau F1^2, without prism.
Eigen::Matrix2d PaperBackCurvature(const Eigen::Matrix2d& front_D, const Eigen::Matrix2d& power_D,
                                   double thickness_mm, double index);

// What a camera on the axis sees through a lens with ground prism, to first order about the axial
// ray: the matrix of ObserverMagnification (optics/magnification.h), to which it tends without
// prism. The pencil meets the tilted back obliquely, leaves deviated, and the feature stands in the
// plane across the axis `depth_mm` behind the back vertex.
Eigen::Matrix2d PrismaticObserverMagnification(const Lens& lens, double index, double camera_mm,
                                               double depth_mm);

// Sphere where the curvatures agree (kSphericalCurvature_per_mm), torus otherwise.
//   across_is_steeper  the meridian across the minus axis is the one of greater signed curvature:
//                      true for a back surface, false for a front one
Surface ToricSurface(const Eigen::Matrix2d& curvature, ToricGenerator generator,
                     bool across_is_steeper);
inline constexpr double kSphericalCurvature_per_mm = 1e-15;

}  // namespace lorgnette
