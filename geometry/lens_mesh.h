// SPDX-License-Identifier: Apache-2.0
// A cut lens as a closed triangle mesh: for export, printing and the accuracy study. No picture
// refracts on it.
#pragma once

#include <optional>
#include <vector>

#include "base/mesh.h"
#include "base/result.h"
#include "optics/lens.h"
#include "optics/surface.h"

namespace lorgnette {

// Where the line through (x, y) along the axis meets a surface, lens frame, normal toward +z;
// nullopt where the surface has ended.
std::optional<SurfaceHit> FrontHit(const Lens& lens, const Eigen::Vector2d& p);
std::optional<SurfaceHit> BackHit(const Lens& lens, const Eigen::Vector2d& p);

struct LensMeshOptions {
  double element_mm = 1.5;       // greatest edge of triangles inside
  int edge_points = 360;         // around the edge
  double bevel_height_mm = 0;    // 0: flat wall along the axis
  double bevel_angle_deg = 115;  // between the flanks
  double groove_width_mm = 0;    // 0: none; not with a bevel
  double groove_depth_mm = 0.5;
  std::vector<double> apex_z_mm;  // of bevel or groove, one a contour point; empty: mid-edge
};

// The plane region is triangulated once (constrained Delaunay, refined to the element size) and
// lifted to both surfaces, with their normals; the wall joins the two rims, over the bevel where
// there is one (its apex runs on the contour, and the surfaces end bevel_height_mm inside), or
// through the groove (a rectangular channel, as wide as the edge leaves room for).
// Creases have a vertex for each side at one position: merged by position the mesh is closed.
Result<TriangleMesh> BuildLensMesh(const Lens& lens, const std::vector<Eigen::Vector2d>& contour_mm,
                                   const LensMeshOptions& options);

}  // namespace lorgnette
