// SPDX-License-Identifier: Apache-2.0
// Closed triangle meshes from a cross-section that travels along a path, with the normals of the
// smooth surface (not of its facets).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "base/mesh.h"
#include "geometry/ring_grid.h"

namespace lorgnette {

// A closed cross-section in its own plane (q, w), counter-clockwise seen with q right, w up.
struct Section {
  std::vector<Eigen::Vector2d> points;
  std::vector<Eigen::Vector2d> tangents;  // unit, along the direction of travel
};

// |q|^e + |w|^e = 1, n points. e = 2: circle; 4: a well rounded square.
Section Superellipse(int n, double exponent);
// Polygon (counter-clockwise) whose corners are rounded with the given radii, `per_corner` points
// an arc; a corner of radius 0 stays one point.
Section RoundedPolygon(const std::vector<Eigen::Vector2d>& corners,
                       const std::vector<double>& radii, int per_corner);

// One point of a ring in space and the direction of the ring there (any length).
struct RingPoint {
  Eigen::Vector3d position, tangent;
};
using Ring = std::vector<RingPoint>;
using RingFunction = std::function<Ring(double s)>;  // same number of points for every s

// Ring by ring around a closed path, as many of them as the fineness asks for; `parameters`
// ascending in [0, 1), the path has period 1.
// Orientation is fixed so that the volume is positive.
TriangleMesh SweepClosed(const RingFunction& ring, const std::vector<double>& parameters,
                         const MeshFineness& fineness);

// A bar: volume_map takes v in [0, 1] along it and (q, w) in its cross-section to space; the
// section shrinks to a point at both ends along elliptic domes that take the fraction dome_start,
// dome_end of v.
using VolumeMap = std::function<Eigen::Vector3d(double v, double q, double w)>;
struct BarShape {
  Section section;
  int rings = 32;      // along the body
  int dome_rings = 5;  // in each end
  double dome_start = 0.02, dome_end = 0.02;
  std::optional<MeshFineness> fineness;  // leaves out what it allows; absent: nothing
};
TriangleMesh SweepBar(const VolumeMap& volume_map, const BarShape& shape);

double SignedVolume(const TriangleMesh& mesh);  // mm^3; positive when triangles face outward

}  // namespace lorgnette
