// SPDX-License-Identifier: Apache-2.0
// Every number that a sheet says of one designed lens: the one source for `lorgnette lens`, its
// JSON and the optician's page, which therefore agree to the last digit.
#pragma once

#include <optional>

#include "optics/design.h"
#include "optics/magnification.h"
#include "optics/outline.h"
#include "optics/paraxial.h"

namespace lorgnette {

// A quantity in the two principal meridians of the order: along the cylinder axis (where the power
// is the sphere) and at 90 degrees to it (sphere plus cylinder). Both meridians of a sphere are the
// same; then `along` lies at 180 degrees.
struct MeridianPair {
  double along = 0;
  double across = 0;
};

// What the sheet is asked besides the lens itself.
struct SheetRequest {
  ObserverGeometry observer;          // camera and feature of the face
  double feature_height_mm = 5.85;    // of the feature off the axis (an iris's edge)
  double feature_meridian_deg = 180;  // TABO meridian on which the feature lies
};

struct LensSheet {
  MeridianPair front_power_D, back_power_D;     // surfaces, F1 and F2
  MeridianPair radius_front_mm, radii_back_mm;  // signed; infinite where plano
  MeridianPair back_vertex_power_D, front_vertex_power_D, equivalent_power_D;
  // The paper's equation (1) at the same surfaces, and exact minus paper.
  MeridianPair paper_power_D, paper_power_error_D;
  // nullopt when afocal in that meridian.
  std::optional<CardinalPoints> cardinal_along, cardinal_across;

  double center_thickness_mm = 0;
  double edge_thickness_min_mm = 0, edge_thickness_max_mm = 0;  // over the contour, axial
  double mass_g = 0;
  double min_blank_mm = 0;  // diameter about the optical centre, allowance included

  // Distant object, entrance pupil at the order's vertex distance + kEntrancePupilDepth_mm.
  double pupil_mm = 0;
  MeridianPair shape_factor, power_factor, spectacle_magnification;

  // The feature as the camera sees it, component along the feature's meridian.
  double observer_magnification_thin = 1;
  double observer_magnification_paraxial = 1;
  std::optional<double> observer_magnification_exact;  // nullopt when no ray reaches the feature
};

LensSheet MakeLensSheet(const LensDesign& design, const SheetRequest& request);

}  // namespace lorgnette
