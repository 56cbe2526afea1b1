// SPDX-License-Identifier: Apache-2.0
// What a lens does over its whole field: power, cylinder, axis, prism, distortion and lateral
// colour for a square grid of gaze directions.
//
// The gaze of grid point (column i, row j) has tangents from -tan(half_angle) to +tan(half_angle)
// about the primary one: x grows with i (toward the wearer's right), y falls with j (row 0 is up).
// Only points within the half angle of the primary gaze count; the corners are outside.
// Source: docs/measurement.md, "Maps".
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/units.h"
#include "optics/gaze.h"
#include "optics/lens.h"

namespace lorgnette {

struct PowerMapOptions {
  int size = 101;              // points a side, >= 2
  double half_angle_deg = 30;  // of eye rotation
  double stop_mm = 27;         // centre of rotation behind the back vertex
  double object_mm = std::numeric_limits<double>::infinity();  // from the front surface
  bool lateral_colour = true;                                  // two more traces a point
};

struct MapPoint {
  RayStatus status = RayStatus::kMissesSurface;  // kMissesSurface also outside the half angle
  Eigen::Vector2d front_mm{0, 0};                // where the gaze crosses the front surface (x, y)
  PowerVector power;                             // at the vertex sphere, Listing's axes, D
  Eigen::Vector2d prism{0, 0};  // 100 tan of the ray's deviation, toward the base (x, y)
  double distortion = 0;        // tangent of the object's angle over its paraxial value, less 1
  double lateral_colour = 0;    // 100 tan of the angle between the F and the C object rays
};

struct PowerMap {
  int size = 0;
  double half_angle_deg = 0;
  std::vector<MapPoint> points;  // row by row, size * size
  const MapPoint& at(int i, int j) const {
    return points[std::size_t(j) * std::size_t(size) + std::size_t(i)];
  }
};

// One core; the rays go through the SIMD kernel, the pencils are followed one by one.
PowerMap MakePowerMap(const Lens& lens, double index, const PowerMapOptions& options = {});

// Ranges over the points that count, for scales of pictures and for reports.
struct MapRange {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();
};
struct MapSummary {
  int points = 0;
  MapRange mean_power_D, cylinder_D, prism, distortion, lateral_colour;  // cylinder as |C|
};
MapSummary Summarize(const PowerMap& map);

}  // namespace lorgnette
