// SPDX-License-Identifier: Apache-2.0
// From a fitted frame and a prescription to eyewear: orders, designs, certifies, cuts and mounts
// both lenses with their optical centres before the pupils.
#pragma once

#include <array>
#include <optional>

#include "base/result.h"
#include "geometry/cut_lens.h"
#include "geometry/eyewear.h"
#include "geometry/fit.h"
#include "optics/design.h"
#include "optics/prescription.h"

namespace lorgnette {

inline constexpr double kBaseStep_D = 0.5;  // how far apart the base curves of blanks are
inline constexpr int kMostBaseSteps = 4;
struct EyewearOptions {
  Medium medium;
  // Of the right and the left lens; by rule when absent, and then nearer to the rims' curve in
  // steps of kBaseStep_D, both lenses alike, where a bevel would miss its groove: the least change
  // after which none does, or, up to kMostBaseSteps, the one that leaves least. A note says so.
  std::array<std::optional<Diopters>, 2> base_curves;
  std::optional<double> center_thickness_mm;  // by rule when absent
  double min_center_thickness_mm = 1.5, min_edge_thickness_mm = 1.0;
  // The optical centre stands at the monocular PD, and at the pupil's height less this much for
  // each degree of pantoscopic tilt (0: before the pupil; opticians lower it by about 0.5 mm/deg so
  // that the lens axis passes the eye's centre of rotation).
  double drop_mm_per_degree = 0;
  CutOptions cut;
};

// The order of one lens in this fit; `optical_centre` receives its place in opening coordinates.
LensOrder OrderLens(Eye eye, const Fit& fit, const Prescription& prescription,
                    const Eigen::Vector3d& pupil, const EyewearOptions& options,
                    Eigen::Vector2d& optical_centre);

//   pupil_right, pupil_left   corneal apices, head space
// wearing.vertex_distance_* are measured on the mounted lenses: along head z from the cornea to the
// back surface. Fails with the sentence of the step that failed, naming the eye.
Result<Eyewear> MakeEyewear(const Fit& fit, const Prescription& prescription,
                            const Eigen::Vector3d& pupil_right, const Eigen::Vector3d& pupil_left,
                            const EyewearOptions& options = {});

// Fits, makes the lenses, and fits once more with the depth that these lenses really have behind
// their grooves, so that the vertex distance asked for is that of the mounted lenses.
struct FittedEyewear {
  Fit fit;
  Eyewear eyewear;
};
Result<FittedEyewear> FitEyewear(const FrameModel& frame, const TriangleMesh& face,
                                 const Eigen::Vector3d& pupil_right,
                                 const Eigen::Vector3d& pupil_left,
                                 const Prescription& prescription,
                                 const FitOptions& fit_options = {},
                                 const EyewearOptions& options = {});

}  // namespace lorgnette
