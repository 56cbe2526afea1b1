// SPDX-License-Identifier: Apache-2.0
// Exact rays through a lens, in double: the reference path for every measurement and picture.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "optics/lens.h"
#include "optics/ray.h"

namespace lorgnette {

// Direction of `incident` after an interface (vector form of Snell's law).
//   incident, normal  unit vectors, either sign of the normal;  eta  n_before / n_after
// Returns nullopt on total internal reflection, and for no other reason.
std::optional<Eigen::Vector3d> Refract(const Eigen::Vector3d& incident,
                                       const Eigen::Vector3d& normal, double eta);

// Mirror direction of `incident` (unit) about `normal` (unit, either sign).
Eigen::Vector3d Reflect(const Eigen::Vector3d& incident, const Eigen::Vector3d& normal);

// Unpolarised Fresnel reflectance in [0, 1] between two lossless media; 1 past the critical angle.
//   cos_incident  |cos| of the angle of incidence;  eta  n_before / n_after
double FresnelReflectance(double cos_incident, double eta);

// Turns directions of the back surface's own axes into the lens frame (the ground prism's tilt).
Eigen::Matrix3d BackRotation(const Lens& lens);
// Hit of the back surface, ray and result in the lens frame.
std::optional<SurfaceHit> IntersectBack(const Lens& lens, const Ray& ray);

// A ray through both surfaces, in either direction (the sign of direction.z says which face comes
// first). `exit` is set when status is kOk; `first` and `second` are the hits reached, in the lens
// frame, normals toward +z.
struct LensTrace {
  RayStatus status = RayStatus::kMissesSurface;
  SurfaceHit first, second;
  Eigen::Vector3d inside_direction{0, 0, 0};  // unit, between the surfaces
  Ray exit{{0, 0, 0}, {0, 0, 0}};             // origin on the second surface
};
LensTrace TraceThrough(const Lens& lens, const Ray& ray, double index);
// At the design index of the medium (d line).
LensTrace TraceThrough(const Lens& lens, const Ray& ray);

}  // namespace lorgnette
