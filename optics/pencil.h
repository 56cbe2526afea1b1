// SPDX-License-Identifier: Apache-2.0
// What a lens does to a narrow pencil, found by exact rays alone: no power formula enters here, so
// the certificate may compare the two.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "optics/lens.h"

namespace lorgnette {

// A limit of finite pencils: rays at heights h, h/2, h/4 around the chief ray are extrapolated to
// h = 0 (the remainder is of sixth order in h). `error` bounds every entry: the difference of the
// last two extrapolations plus rounding.
struct PencilPower {
  Eigen::Matrix2d power_D;  // vergence at the back vertex, lens frame, across the leaving ray
  double power_error_D = 0;
  Eigen::Vector2d prism{0, 0};  // 100 tan of the deviation, lens frame's x, y, toward the base
  double prism_error = 0;
};
// Pencil parallel to the axis, chief ray through the front vertex. nullopt when a ray is lost.
std::optional<PencilPower> MeasurePower(const Lens& lens, double index);

// Power of one front surface at the point over (x, y): a pencil along its normal there, refracted
// once, the vergence across it just inside. Prism is zero by construction.
std::optional<PencilPower> MeasureFrontPower(const Surface& front, const Eigen::Vector2d& at,
                                             double index);

struct PencilMagnification {
  Eigen::Matrix2d magnification;  // as ObserverMagnification in optics/magnification.h
  double error = 0;
};
// Pencil from a pinhole on the axis, `camera_mm` before the front vertex, to the plane `depth_mm`
// behind the back vertex.
std::optional<PencilMagnification> MeasureObserverMagnification(const Lens& lens, double index,
                                                                double camera_mm, double depth_mm);

inline constexpr double kPencilHeight_mm = 0.4;  // the widest of the three pencils

}  // namespace lorgnette
