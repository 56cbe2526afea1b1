// SPDX-License-Identifier: Apache-2.0
// The lens as worn: tilted before the eye, and at another distance than the refraction was made at.
//
// A trial lens stands straight before the eye; the finished one leans by the pantoscopic tilt and
// turns by the face form. Source: docs/optics.md, "Position of wear".
#pragma once

#include "base/result.h"
#include "optics/design.h"
#include "optics/gaze.h"
#include "optics/power_vector.h"

namespace lorgnette {

struct WearPosition {
  double pantoscopic_deg = 0;  // > 0: the lens' lower edge nearer the cheek
  double face_form_deg = 0;    // > 0: its temporal edge nearer the head
  double vertex_distance_mm = 13;
};

// The eye behind a lens so worn, primary gaze through the back vertex.
EyePose WornEye(const Lens& lens, Eye eye, const WearPosition& wear, double stop_mm = 27);

// Power that the eye meets in primary gaze, and the prism that the tilt adds (base in, base up).
struct WornPower {
  PowerVector power;
  double prism_in = 0, prism_up = 0;
};
Result<WornPower> MeasureWorn(const Lens& lens, Eye eye, const WearPosition& wear);

// The order whose lens, worn as `wear` says, gives the eye what `order.rx` gives at
// `refraction_vertex_mm` and without tilt. Exact for the traced lens: the order is corrected by
// what the rays miss until they miss less than kWearTolerance_D (some five designs).
struct WearCompensation {
  LensDesign design;    // of the compensated order; its rx is what to make
  PowerVector target;   // at the lens plane as worn
  WornPower worn;       // by rays, of the compensated lens
  WornPower untouched;  // by rays, of the order as written: what compensation is good for
};
inline constexpr double kWearTolerance_D = 1e-9;
Result<WearCompensation> CompensateForWear(const LensOrder& order, double refraction_vertex_mm,
                                           const WearPosition& wear);

// Thin lens tilted about a meridian, chief ray through its vertex: exact.
//   F_eff = G C^-1 F C^-1, C = diag(1, cos) with axis 1 the tilt axis, G = (n cos t' - cos t)/(n -
//   1) axis_angle  radians of the tilt axis in the axes of `power_D`
Eigen::Matrix2d ThinTilted(const Eigen::Matrix2d& power_D, double tilt, double axis_angle,
                           double index);
// Martin's rule, its second-order expansion for spheres: S (1 + sin^2 t / 2n), cylinder S' tan^2 t
// with its axis along the tilt axis. For comparison only.
SphereCylinder MartinTilted(Diopters sphere, double tilt, double index, AxisDegrees tilt_axis);

}  // namespace lorgnette
