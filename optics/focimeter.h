// SPDX-License-Identifier: Apache-2.0
// A focimeter with a stated aperture: what the instrument reads, as against the paraxial power.
//
// The instrument stands on the back surface: its beam is normal to that surface at the point
// measured, its pupil a ring of the stated radius on the tangent plane there, the target at
// infinity on the front side (or, for the front vertex power, the lens turned round). The reading
// is the vergence matrix that fits the ring's rays best: zone error and all. The eye does not turn
// here, so this is not the power as worn. Source: docs/measurement.md, "Focimeter"; zone errors
// there.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "optics/lens.h"
#include "optics/power_vector.h"

namespace lorgnette {

struct FocimeterOptions {
  double pupil_radius_mm = 2.5;  // a real instrument; 0.1 or less tests the formula
  int rays = 12;                 // on the ring, at least 4
};

struct FocimeterReading {
  Eigen::Matrix2d power_D{{0, 0}, {0, 0}};  // lens frame's x, y
  SphereCylinder power;                     // the same, minus-cylinder form
  Eigen::Vector2d prism{0, 0};  // 100 tan of the deviation of the central ray, toward the base
  double residual_D = 0;        // rms of slopes that no sphero-cylinder explains, over the radius
};

// At (x, y) on the back surface, lens frame. nullopt when a ray of the ring is lost.
std::optional<FocimeterReading> ReadBackVertexPower(const Lens& lens, double index,
                                                    const Eigen::Vector2d& at_mm,
                                                    const FocimeterOptions& options = {});

// With the lens turned round, at (x, y) on the front surface. The reading is in the lens frame as
// it stands, not as it lies in the instrument. A multifocal's add is measured this way on the side
// that carries the segment: reading at the near point less reading at the distance point.
std::optional<FocimeterReading> ReadFrontVertexPower(const Lens& lens, double index,
                                                     const Eigen::Vector2d& at_mm,
                                                     const FocimeterOptions& options = {});

// Travel of the target from zero, mm: x = f_s^2 F'v / 1000, f_s the standard lens.
double FocimeterTargetTravel(Diopters power, Diopters standard_lens);

}  // namespace lorgnette
