// SPDX-License-Identifier: Apache-2.0
// How much a lens magnifies: for its wearer, and for somebody who looks at the wearer.
//
// All numbers are ratios with the lens over without it. Distances in mm. Matrices act on vectors of
// the lens frame's x, y (optics/ray.h). Source: docs/measurement.md, "Magnification"; the
// observer's form is exact to first order and was derived for this program.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/units.h"
#include "optics/lens.h"
#include "optics/paraxial.h"

namespace lorgnette {

// Distance from the cornea to the entrance pupil of a schematic eye (Gullstrand no. 1).
inline constexpr double kEntrancePupilDepth_mm = 3.05;

// --- the wearer, distant object -----------------------------------------------------------------

// Shape factor 1 / (1 - tau F1) and power factor 1 / (1 - d F'v).
//   pupil_mm  back vertex to entrance pupil: vertex distance + kEntrancePupilDepth_mm
double ShapeFactor(Diopters front, double thickness_mm, double index);
double PowerFactor(Diopters back_vertex_power, double pupil_mm);
// Their product, for any symmetric system in air.
double SpectacleMagnification(const ParaxialSystem& system, double pupil_mm);
// (I - d F'v)^-1 (I - tau F1)^-1: not symmetric for obliquely crossed surfaces.
Eigen::Matrix2d SpectacleMagnification(const AstigmaticSystem& system, double pupil_mm);

// --- the wearer, object at a distance ---------------------------------------------------------

// Angle at the entrance pupil with the lens over that without, the object `object_mm` before the
// front vertex of a lens `thickness_mm` thick.
double SpectacleMagnificationNear(const ParaxialSystem& system, double thickness_mm,
                                  double pupil_mm, double object_mm);

// --- the observer
// ---------------------------------------------------------------------------------

// A pinhole camera on the axis, `camera_mm` before the front vertex, and a feature of the face at
// `depth_mm` behind the back vertex (an iris: its image in the cornea).
struct ObserverGeometry {
  double camera_mm = 500;
  double depth_mm = 15.05;
};

// The image that the camera sees, to first order. J is (feature height) / (camera angle).
struct ObserverView {
  double magnification = 1;        // (L + t + z) / J
  double lateral = 1;              // image height / feature height; does not depend on L
  double apparent_depth_mm = 0;    // image behind the FRONT vertex; infinite where lateral is
  double camera_height_ratio = 0;  // height at the front vertex plane / feature height: L / J
};

// 1 / (1 - z L F / (L + z)).
double ObserverMagnificationThin(Diopters power, const ObserverGeometry& geometry);
ObserverView ObserverParaxial(const ParaxialSystem& system, double thickness_mm,
                              const ObserverGeometry& geometry);
// (L + t + z) J^-1. At infinity the transpose of SpectacleMagnification with the same depth.
Eigen::Matrix2d ObserverMagnification(const AstigmaticSystem& system, double thickness_mm,
                                      const ObserverGeometry& geometry);
Eigen::Matrix2d ObserverMagnification(const Lens& lens, double index,
                                      const ObserverGeometry& geometry);

// By an exact ray: from the camera through both surfaces to the feature, which stands `feature_mm`
// off the axis (x, y) in the plane `depth_mm` behind the back vertex. Axis: that of the lens frame.
struct ObserverRay {
  double magnification = 1;  // component of the tangent along the feature, with / without
  Eigen::Vector2d camera_tangent{0, 0};  // of the ray at the camera, with the lens
  Eigen::Vector2d front_mm{0, 0};        // where it crosses the front surface
};
// nullopt when no ray reaches the feature (past the sag sheet, or total reflection).
// A feature nearer than kObserverMinHeight_mm to the axis is moved out to it, along +x if it lies
// on the axis; the ratio there is within 1e-10 of its limit.
inline constexpr double kObserverMinHeight_mm = 1e-3;
std::optional<ObserverRay> ObserverExact(const Lens& lens, double index,
                                         const ObserverGeometry& geometry,
                                         const Eigen::Vector2d& feature_mm);

}  // namespace lorgnette
