// SPDX-License-Identifier: Apache-2.0
// Frame and two certified lenses, worn: everything in head space, ready for the renderer.
//
// Head space: +x toward the wearer's left, +y up, +z out of the face, origin midway between the
// pupils (corneal apices), mm.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "base/mesh.h"
#include "geometry/frame_model.h"
#include "optics/certify.h"

namespace lorgnette {

// A certified lens cut to the opening and mounted. Contour in the lens frame (optics/ray.h), closed
// polygon, counter-clockwise seen by someone facing +z of the lens frame turned away, that is
// counter-clockwise in (x, y).
struct CutLens {
  CertifiedLens lens;
  std::vector<Eigen::Vector2d> contour_mm;  // lens frame, through the edge
  Eigen::Isometry3d frame_from_lens = Eigen::Isometry3d::Identity();
  TriangleMesh mesh;           // lens frame; closed; for export and studies
  double mount_misfit_mm = 0;  // greatest distance from bevel to groove, along the axis
  double rim_steeper_D = 0;    // groove's curve less the front's, at the tooling index 1.530
  // z of the bevel's apex (or the groove's middle, or of a flat edge), one a contour point.
  std::vector<double> apex_z_mm{};
  std::vector<std::string> notes{};  // "bevel 0.4 mm off the groove at 110 degrees: ..."
};

// How the glasses sit, as an optician measures it.
struct WearingPosition {
  double vertex_distance_right_mm = 0, vertex_distance_left_mm = 0;  // back vertex to cornea
  double pantoscopic_tilt_deg = 0;  // front against the head's vertical
  double face_form_deg = 0;
  double fitting_height_right_mm = 0, fitting_height_left_mm = 0;  // pupil above boxing centre
  double nose_penetration_mm = 0;  // deepest point of the frame inside the nose, 0 when none
  double nose_gap_mm = 0;          // smallest distance of the contacts to the skin, 0 at contact
  std::vector<std::string> notes;  // "frame 6 mm wider than the face at the temples"
};

struct Eyewear {
  FrameModel frame;
  CutLens right, left;
  Eigen::Isometry3d head_from_frame = Eigen::Isometry3d::Identity();
  WearingPosition wearing;
};

}  // namespace lorgnette
