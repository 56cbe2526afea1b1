// SPDX-License-Identifier: Apache-2.0
// Rays in a lens frame, and what can happen to them.
//
// Lens frame (docs/optics.md, "Signs"): origin at the FRONT vertex, +z along the optical axis from
// the world toward the eye, +y up, +x toward the WEARER'S RIGHT (so the triad is right-handed).
// The back vertex lies at z = centre thickness. A TABO meridian A has direction (-cos A, sin A).
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace lorgnette {

struct Ray {
  Eigen::Vector3d origin;     // mm
  Eigen::Vector3d direction;  // unit
};

// Every traced ray ends with one of these; no NaN ever leaves the optics.
enum class RayStatus : std::uint8_t {
  kOk,
  kMissesSurface,            // no intersection on the sag sheet
  kTotalInternalReflection,  // past the critical angle at a refracting surface
};

}  // namespace lorgnette
