// SPDX-License-Identifier: Apache-2.0
// Cuts a certified lens to an opening and mounts it, as an edger and an optician do.
#pragma once

#include <optional>
#include <vector>

#include "base/result.h"
#include "geometry/eyewear.h"
#include "optics/certify.h"

namespace lorgnette {

enum class EdgeForm {
  kFlat,    // polished wall along the axis (rimless)
  kBevel,   // V that enters the rim's groove
  kGroove,  // a channel for the thread of a half rim
};
// The edge that a frame's mount asks for.
EdgeForm EdgeFor(FrameMount mount);

struct CutOptions {
  std::optional<EdgeForm> edge;  // absent: the one that the frame's mount asks for
  double bevel_height_mm = 0.6;
  double bevel_angle_deg = 115;  // between the flanks
  // Apex at this fraction of the edge from the front all around; absent: the apex follows the rim's
  // groove wherever the edge is thick enough, about a third of the edge from the front.
  std::optional<double> bevel_position;
  double bevel_margin_mm = 0.3;  // of edge on either side of the apex, where it is so thick
  double groove_width_mm = 0.6, groove_depth_mm = 0.5;
  double blank_diameter_mm = 85;  // centred on the optical centre
  double min_edge_mm = 0.5;       // thinner, and the rim cannot hold the lens
  double element_mm = 1.5;        // greatest edge of the mesh's triangles inside
  int edge_points = 360;          // of the mesh around the edge
};

// A contour of an opening in the lens frame (optics/ray.h) of a lens whose optical centre lies at
// `optical_centre` in opening coordinates: x is mirrored, so the order is reversed to stay
// counter-clockwise in (x, y).
std::vector<Eigen::Vector2d> ContourInLensFrame(const std::vector<Eigen::Vector2d>& contour_mm,
                                                const Eigen::Vector2d& optical_centre);

// Cuts to opening.contour_mm and slides the lens along its axis, parallel to the opening's, until
// the edge meets the groove: the greatest distance along the axis is then least, and stands in
// mount_misfit_mm. A bevel follows the groove's own curve within the edge, as edgers cut it (the
// misfit is what a thin edge leaves over, with a note that names the place); the apex of a fixed
// bevel_position, a groove, and the middle of a flat edge follow the lens.
// Fails when the blank is too small, a surface ends inside the contour, or the edge is too thin,
// each with the figures.
// Tested: mesh closed, oriented and free of self-intersection; its volume is the closed form on a
// round lens to 0.1 %; normals are the surfaces'.
Result<CutLens> CutAndMount(const CertifiedLens& lens, const LensOpening& opening,
                            const Eigen::Vector2d& optical_centre, const CutOptions& options = {});
// A note is made of a misfit beyond this.
inline constexpr double kMisfitNote_mm = 0.15;

// Axial thickness at the contour in `count` equal steps of angle from +x of opening coordinates,
// counter-clockwise, around the boxing centre (how OMA files count).
std::vector<double> EdgeThicknessByAngle(const CutLens& lens, const LensOpening& opening,
                                         int count);

}  // namespace lorgnette
