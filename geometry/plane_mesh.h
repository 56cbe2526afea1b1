// SPDX-License-Identifier: Apache-2.0
// Conforming triangulation of the inside of a plane polygon.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/result.h"
#include "geometry/closed_curve.h"

namespace lorgnette {

// One point of the triangulation on the polygon: `fraction` of the way along edge `edge`.
struct BoundaryPoint {
  int index = 0;
  int edge = 0;
  double fraction = 0;
};

struct PlaneMesh {
  Polygon2 points;
  std::vector<Eigen::Vector3i> triangles;  // counter-clockwise
  std::vector<BoundaryPoint> boundary;     // in the polygon's order
};

// Constrained Delaunay, refined until edges are no longer than element_mm and angles at least
// 20.7 degrees where the polygon allows. The polygon's points are kept; its edges may be split.
// Fails when the polygon is not simple or not counter-clockwise.
Result<PlaneMesh> TriangulatePolygon(const Polygon2& polygon, double element_mm);

}  // namespace lorgnette
