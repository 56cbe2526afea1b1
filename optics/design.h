// SPDX-License-Identifier: Apache-2.0
// From an order to a lens: base curve, back curve(s), thickness.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "base/result.h"
#include "base/units.h"
#include "optics/back_surface.h"
#include "optics/base_curve.h"
#include "optics/front_form.h"
#include "optics/lens.h"
#include "optics/prescription.h"

namespace lorgnette {

enum class ToricSide { kBack, kFront };
// How F2 follows from the order: exactly, or by the paper's equation (1), P = F1 + F2 + tau F1^2,
// whose lens errs by PaperPowerError (optics/paraxial.h).
enum class PowerForm { kExact, kPaper };

// Everything that fixes one lens. Contour points are in the lens frame's x, y (optics/ray.h: +x
// toward the wearer's right, +y up), relative to the optical centre.
struct LensOrder {
  Eye eye = Eye::kRight;
  EyePrescription rx;  // sphere means exact back vertex power
  Medium medium;
  std::optional<Diopters> base_curve;         // true power at the lens index; by rule when absent
  std::optional<double> center_thickness_mm;  // by rule when absent
  double min_center_thickness_mm = 1.5;       // what fixes the thickness of minus lenses
  double min_edge_thickness_mm = 1.0;         // what fixes that of plus ones, over the contour
  std::vector<Eigen::Vector2d> contour_mm;    // closed polygon, either orientation; empty: round
  double diameter_mm = 60;                    // of the round lens when there is no contour
  double vertex_distance_mm = 13;             // back vertex to cornea, for the magnification
  ToricGenerator generator = ToricGenerator::kAcrossMinusAxis;

  BaseCurveRule base_rule = BaseCurveRule::kVogel;  // where no base curve is given
  ToricSide toric_side = ToricSide::kBack;
  PowerForm power_form = PowerForm::kExact;
  // Aspheric front: a fourth-order term that frees the lens of oblique astigmatism at this eye
  // rotation (degrees, about `stop_mm` behind the back vertex).
  std::optional<double> aspheric_gaze_deg;
  double stop_mm = 27;
  // Multifocal front, for an addition in `rx`: at most one of the two.
  std::optional<SegmentOrder> segment;
  std::optional<ProgressiveOrder> progressive;
};

inline constexpr double kBlankAllowance_mm =
    2;  // a blank is this much wider than the outline needs

struct LensDesign {
  LensOrder order;
  Lens lens;
  Diopters front_power;                                         // F1
  Diopters back_power_axis;                                     // F2 along the cylinder axis
  Diopters back_power_across;                                   // F2 at the axis + 90
  double min_edge_thickness_mm = 0, max_edge_thickness_mm = 0;  // over the contour, axial
  double mass_g = 0;
  double min_blank_mm = 0;  // diameter about the optical centre, kBlankAllowance_mm included
};

// Prism is ground: the back surface turns about its vertex, and its curvatures are those that keep
// the power along the deviated ray exact. With a toric front the base curve is the flatter front
// meridian and the back is spherical. The thickness is the least with which the centre and
// every point of the contour keep their minima, solved together with the back curve. Fails with
// what is impossible and what would be possible (no real sag at the rim, tau F1 > 0.5).
Result<LensDesign> DesignLens(const LensOrder& order);

}  // namespace lorgnette
