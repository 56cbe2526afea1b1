// SPDX-License-Identifier: Apache-2.0
// The lens openings of a frame, measured on its mesh as a tracing machine would: seen from the
// front along each opening's own axis, inner edge of the rim and bottom of its groove.
#pragma once

#include <vector>

#include "base/mesh.h"
#include "base/result.h"
#include "geometry/frame_model.h"

namespace lorgnette {

struct ContourOptions {
  int points = 720;             // of the contour, at equal steps of arc length
  int spline_pieces = 144;      // of the smooth closed curve fitted through the trace
  double min_groove_mm = 0.05;  // a hollow less deep is no groove
  double min_area_mm2 = 250;    // of an opening seen from the front
  double search_mm = 40;        // greatest radius of an opening
};

// One opening around the axis (+z of frame_from_axis, through a point inside the opening).
// The opening's plane is fitted to the trace, and the trace repeated along its normal, until they
// agree; the origin moves to the boxing centre. Where the rim has no groove the contour is the
// aperture. Fails when some direction from the axis meets no rim ("no closed rim"), or when a part
// of the mesh crosses the axis.
Result<LensOpening> TraceOpening(const TriangleMesh& front,
                                 const Eigen::Isometry3d& frame_from_axis,
                                 const ContourOptions& options = {});

struct TracedOpenings {
  LensOpening right, left;
  Boxing boxing;                    // mean of both, DBL between them
  double face_form_deg = 0;         // of each opening's plane to the frame's, mean
  double frame_curve_diopters = 0;  // of the groove, at tooling index 1.530, mean
};
// Finds the two openings of a front seen along the frame's +z and traces them.
Result<TracedOpenings> TraceOpenings(const TriangleMesh& front, const ContourOptions& options = {});

// The same of the lenses themselves, where no closed rim holds them (half rim, rimless): their
// outlines, and the middles of their edges in place of the groove. Any two discs seen along +z.
Result<TracedOpenings> TraceLenses(const TriangleMesh& lenses, const ContourOptions& options = {});

// Share of the directions around an opening in which the front has a rim at its contour: about 1
// for a full rim, 0 for a lens that nothing holds but screws.
double RimShare(const TriangleMesh& front, const LensOpening& opening);

// All parts of one kind as one mesh.
TriangleMesh PartsOfKind(const FrameModel& frame, FramePartKind kind);

// Greatest distance from the traced contours to the true ones, over our parametric frames
// (tests/geometry/contour_test.cc).
inline constexpr double kContourError_mm = 0.02;

}  // namespace lorgnette
