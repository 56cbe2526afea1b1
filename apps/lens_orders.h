// SPDX-License-Identifier: Apache-2.0
// From options to lenses: orders, and the lens made of an order with prism, tilt and all.
#pragma once

#include <optional>

#include "apps/lens_options.h"
#include "base/result.h"
#include "geometry/frame_model.h"
#include "optics/prescription.h"
#include "optics/prism_design.h"
#include "optics/wear.h"

namespace lorgnette {

// A lens and how it came about.
struct MadeLens {
  LensDesign design;
  EyePrescription written;               // the prescription as it was given
  PrismDiopters thinning_down;           // ground in besides, for a progressive
  std::optional<PrismDesign> prism;      // asked to be made by decentration
  std::optional<WearCompensation> wear;  // compensated for how it is worn
  std::optional<WearPosition> worn_as;   // ... as
  double refraction_vertex_mm = kDefaultVertex_mm;
};

// Check ranges; errors name the option. The second takes the power from `rx`.
Result<LensOrder> OrderFromOptions(const LensOptions& options);
Result<LensOrder> OrderFromPrescription(const EyePrescription& rx, Eye eye,
                                        const LensOptions& options);

// The lens' outline from a frame: the opening's shape about the pupil, which stands at the
// monocular PD and at the fitting height above the lowest point of the lens (absent: on the
// mid-line).
void SetFrameContour(const FrameModel& frame, double pd_mm, std::optional<double> fitting_height_mm,
                     LensOrder& order);

// Designs the order as the options say: thinning, decentration, compensation for the wear.
Result<MadeLens> MakeLens(const LensOrder& order, const LensOptions& options);

// The designed lens, or the lens of the given surfaces, whose order then says what it is.
Result<MadeLens> LensFromOptions(const LensOptions& options);

}  // namespace lorgnette
