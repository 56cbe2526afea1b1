// SPDX-License-Identifier: Apache-2.0
// Sets a frame on a face as an optician does: pads on the nose, temples on the ears, pupils at a
// sensible height in the openings.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "base/mesh.h"
#include "base/result.h"
#include "geometry/eyewear.h"
#include "geometry/frame_model.h"

namespace lorgnette {

// Where the temples rest: the upper root of each ear (otobasion superius), head space.
struct EarPoints {
  Eigen::Vector3d right{-74, 0, -89}, left{74, 0, -89};
};
// A tracked face of the canonical 468 vertices ends before the ears: they are continued from its
// sides by mean anatomy. For any other mesh: the mean head, scaled by the pupils' distance.
EarPoints EstimateEars(const TriangleMesh& face, double pd_mm);

struct FitOptions {
  double min_vertex_mm = 12, max_vertex_mm = 14;  // back vertex to cornea, reached where possible
  double lens_depth_mm = 2.5;                     // estimate: back vertex behind the groove's plane
  std::optional<double> pupil_height_mm;          // above the boxing centre; absent: by lens height
  std::optional<double> tilt_deg;                 // pantoscopic; absent: as the ears have it
  std::optional<EarPoints> ears;                  // absent: estimated
  // Whether the bridge is chosen for the nose, as an optician would: among the sizes the frame is
  // offered in, pads on arms bent, acetate pads filed back or built up. Parametric frames only,
  // but for the arms.
  bool adapt_bridge = true;
  double pad_travel_mm = 3;            // how far pads on arms may be bent sideways
  double pad_filing_mm = 1.5;          // how far acetate pads may be filed back
  double pad_build_up_mm = 2;          // and built up
  Eigen::Vector3d nudge_mm{0, 0, 0};   // afterwards, head axes
  Eigen::Vector3d nudge_deg{0, 0, 0};  // about head x, y, z through the bridge
};

struct Fit {
  FrameModel frame;  // as adjusted: bridge chosen, pads moved, temples opened to the ears
  Eigen::Isometry3d head_from_frame = Eigen::Isometry3d::Identity();
  WearingPosition wearing;
  EarPoints ears;
  double pad_shift_mm = 0;        // each pad's face moved outward by this much
  double temple_opening_deg = 0;  // mean swing of the temples about their hinges, outward positive
};

//   face          head space (+x wearer's left, +y up, +z forward), at least nose, cheeks and brow
//   pupil_right, pupil_left   corneal apices, head space
// The contacts touch: none is deeper in the skin than kContactDepth_mm plus the map's error, at
// least one on each side touches, and no other part of the front enters the skin. Symmetric: both
// sides' contacts press alike. A head of another width than the frame's is a note with the figure.
// Fails when the nose is not in the mesh below the frame.
Result<Fit> PlaceOnFace(const FrameModel& frame, const TriangleMesh& face,
                        const Eigen::Vector3d& pupil_right, const Eigen::Vector3d& pupil_left,
                        const FitOptions& options = {});

// Skin gives way by this much under the pads.
inline constexpr double kContactDepth_mm = 0.2;

// Notes a vertex distance outside the options' range; for the lenses as they are made, of which
// PlaceOnFace knows the depth only by assumption.
void NoteVertexDistance(const FitOptions& options, WearingPosition& wearing);

}  // namespace lorgnette
