// SPDX-License-Identifier: Apache-2.0
// An eyeglass frame described by numbers (docs/frames.md explains each with a picture).
//
// Shapes are given for the wearer's left half, seen from the front: x grows toward the temple, y
// up; the right half is its mirror image. Lengths in mm, angles in degrees.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/result.h"
#include "geometry/closed_curve.h"
#include "geometry/frame_model.h"

namespace lorgnette {

// Local widening of the rim, where its outward normal points to angle_deg (0 temple, 90 up).
struct RimFlare {
  double angle_deg = 45, spread_deg = 20;
  double width_mm = 0;
};

struct RimParameters {
  double top_mm = 3, bottom_mm = 2.5, nasal_mm = 3, temporal_mm = 3;  // width beyond the outline
  std::vector<RimFlare> flares;
  double depth_mm = 4;  // front to back
  double lip_mm = 0.6;  // the rim covers the lens by this much; also the depth of the groove
  double groove_width_mm = 1.4;
  double rounding_mm = 1.2;  // radius of the outer edges
  std::string material;
};

// One bar between the rims; a frame may have two (aviator). Attach angles: where on the outline the
// upper and lower edges of the bar leave, as angle of the outline's point (180 nasal, 90 top).
struct BridgeParameters {
  double attach_top_deg = 150, attach_bottom_deg = 180;
  double rise_top_mm = 0, rise_bottom_mm = 0;  // middle above the attachment
  double forward_mm = 0;                       // middle in front of the attachment
  double depth_mm = 4;                         // front to back in the middle
  std::string material;
};

// Nose pads: on arms (metal), or of one piece with the rim (acetate) when arm_mm is 0.
struct PadParameters {
  double height_mm = 13, width_mm = 7.5, thickness_mm = 2.2;
  double half_gap_mm = 8.5;                 // from the middle plane to the pad's contact face
  double y_mm = -5, z_mm = -5;              // centre of the pad, frame coordinates
  double frontal_deg = 22, splay_deg = 28;  // lean of the face from the vertical; turn to the back
  double arm_mm = 0.5;                      // radius of the arm's wire; 0: no arm
  std::string material, arm_material;
};

struct EndPieceParameters {
  double angle_deg = 30;  // where on the outline it leaves
  double height_mm = 8, thickness_mm = 4;
  double reach_mm = 4;  // sideways beyond the rim
  double back_mm = 5;   // from the front plane back to the hinge
  std::string material;
};

struct TempleParameters {
  double length_mm = 145, to_bend_mm = 97;   // along the middle line
  double height_mm = 7, thickness_mm = 3.2;  // at the hinge
  double middle_height_mm = 5, tip_height_mm = 7;
  double bend_deg = 42, tip_inward_deg = 8;
  double spread_mm = 142;    // distance between the inner faces at the bend
  double tip_sleeve_mm = 0;  // length of a thicker sleeve at the end (metal temples)
  double tip_thickness_mm = 3.2;
  std::string material, tip_material;
};

struct FrameParameters {
  std::string name, description;
  FrameMount mount = FrameMount::kFullRim;   // half rim: above only; rimless: no rim at all
  double a_mm = 50, b_mm = 40, dbl_mm = 18;  // boxing, of the groove bottom
  std::vector<double> bridge_sizes_mm;       // the DBL values it is offered in; empty: dbl_mm alone
  Polygon2 outline;                          // control points of a ClosedSpline, any size
  double pantoscopic_tilt_deg = 8, face_form_deg = 4;
  double frame_curve_diopters = 3;  // of the groove, at tooling index 1.530
  RimParameters rim;
  std::vector<BridgeParameters> bridges;
  PadParameters pads;
  EndPieceParameters end_piece;
  TempleParameters temples;
  std::map<std::string, FrameMaterial> materials;
};

// Strict reading: unknown keys, values out of range and materials that are not defined are errors.
Result<FrameParameters> ParseFrameParameters(const std::string& json_text, const std::string& name);

}  // namespace lorgnette
