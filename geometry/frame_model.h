// SPDX-License-Identifier: Apache-2.0
// An eyeglass frame: closed meshes by part, the two lens openings, and boxing dimensions.
//
// Frame coordinates: origin midway between the boxing centres of the two lens openings, in the
// lens plane; +x toward the wearer's LEFT, +y up, +z away from the face (the head's axes before
// tilt). Lengths in mm.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "base/mesh.h"
#include "geometry/frame_material.h"

namespace lorgnette {

struct FrameParameters;

enum class FramePartKind { kFront, kTemple, kNosePad, kHinge, kDemoLens, kOther };

struct FramePart {
  std::string name;
  FramePartKind kind = FramePartKind::kOther;
  TriangleMesh mesh;  // frame coordinates, with normals; uvs where the file has them
  FrameMaterial material;
};

// What holds the lenses.
enum class FrameMount { kFullRim, kHalfRim, kRimless };

// One lens opening. Opening coordinates: origin at the boxing centre in the opening's own plane,
// +x toward the wearer's left and +y up in that plane, +z away from the face.
struct LensOpening {
  Eigen::Isometry3d frame_from_opening = Eigen::Isometry3d::Identity();
  // Shape of the lens (groove bottom), closed polygon without repeated point, counter-clockwise,
  // mm, in the opening's plane. `aperture_mm` is the visible inner edge of the rim (lip).
  std::vector<Eigen::Vector2d> contour_mm;
  std::vector<Eigen::Vector2d> aperture_mm;
  // z of the groove bottom in opening coordinates, one a contour point (a wrapped rim follows a
  // curve); mean 0; empty: flat.
  std::vector<double> groove_height_mm;
};

struct Boxing {
  double a_mm = 0, b_mm = 0, dbl_mm = 0;  // lens width, height, distance between lenses
  double effective_diameter_mm = 0;       // 2 * greatest radius from the boxing centre
  double circumference_mm = 0;
  double frame_pd_mm() const { return a_mm + dbl_mm; }
};

struct FrameModel {
  std::string name;
  std::vector<FramePart> parts;
  FrameMount mount = FrameMount::kFullRim;
  LensOpening right, left;
  Boxing boxing;
  double pantoscopic_tilt_deg = 8;  // of the front to the temples
  double temple_length_mm = 140;
  double temple_spread_mm = 0;  // distance between the temples' inner faces at the ears
  // Points of the frame that rest on the nose: pad or bridge contact patches (frame coordinates).
  std::vector<Eigen::Vector3d> nose_contacts;
  // Where each temple bends down over the ear, frame coordinates (right, left).
  Eigen::Vector3d ear_point_right{0, 0, 0}, ear_point_left{0, 0, 0};
  double face_form_deg = 0, frame_curve_diopters = 0;  // of the openings, tooling index 1.530
  std::vector<std::string> notes;  // what a loader guessed or repaired: "unit guessed: ..."
  // What a parametric frame was built from, so that it can be made in another bridge size; null for
  // a frame from a model.
  std::shared_ptr<const FrameParameters> parameters;
};

}  // namespace lorgnette
