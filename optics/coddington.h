// SPDX-License-Identifier: Apache-2.0
// What happens to a narrow pencil around a skew ray: the generalised Coddington equations, and
// differential rays, which find the same by another way.
//
// The vergence of a pencil is a symmetric 3x3 tensor with the ray's direction in its kernel: no
// basis has to be carried along, and a rotation of the frame rotates it. Reduced vergence (index
// times wavefront curvature) in dioptres, positive converging. Everything in the lens frame.
// Source: docs/measurement.md, "Coddington"; Theta' V' Theta' = Theta V Theta + O K.
// Tested: goldens C1 and C4; both ways agree to kCoddingtonAgreement_D.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "optics/lens.h"
#include "optics/ray.h"
#include "optics/trace.h"

namespace lorgnette {

// Coddington against differential rays over random lenses with vergences up to 100 D.
inline constexpr double kCoddingtonAgreement_D = 1e-9;

// A narrow pencil where its chief ray starts.
struct Wavefront {
  Ray chief;
  Eigen::Matrix3d vergence_D = Eigen::Matrix3d::Zero();
};

// A spherical wave of this vergence (0: plane wave) at the start of `chief`.
Wavefront SphericalWave(const Ray& chief, double vergence_D);

// The pencil `distance_mm` farther along its ray (negative: back), in a medium of this index.
// Infinite entries where that is a focus.
Wavefront Propagated(const Wavefront& wavefront, double distance_mm, double index);

// Normal and curvature of a surface at one point: `curvature` acts on tangent vectors, 1/mm,
// positive where the surface bends toward its normal.
struct SurfaceBend {
  Eigen::Vector3d normal;  // unit
  Eigen::Matrix3d curvature;
};
// At (x, y) of the surface's own frame, whose axes `rotation` turns into the lens frame.
std::optional<SurfaceBend> BendAt(const Surface& surface, double x, double y,
                                  const Eigen::Matrix3d& rotation);
// At a point of the lens frame.
std::optional<SurfaceBend> FrontBendAt(const Lens& lens, const Eigen::Vector3d& point);
std::optional<SurfaceBend> BackBendAt(const Lens& lens, const Eigen::Vector3d& point);

// Vergence after a refraction from `in` to `out` (unit directions that obey Snell's law) at a
// surface of this bend, either sign of its normal.
Eigen::Matrix3d RefractedVergence(const Eigen::Matrix3d& vergence_D, const SurfaceBend& bend,
                                  const Eigen::Vector3d& in, const Eigen::Vector3d& out,
                                  double index_before, double index_after);

// Through both surfaces, either way. `exit` starts on the second surface; set when status is kOk.
struct WavefrontTrace {
  RayStatus status = RayStatus::kMissesSurface;
  LensTrace rays;
  Wavefront exit;
};
WavefrontTrace TraceWavefront(const Lens& lens, double index, const Wavefront& in);
// The same for a ray that is already traced; `in` starts on the first surface.
std::optional<Wavefront> WavefrontThrough(const Lens& lens, double index, const LensTrace& rays,
                                          const Wavefront& in);

// --- differential rays ----------------------------------------------------------------------

// Derivatives of a ray's origin and direction in two parameters, one column each.
struct RayDifferential {
  Eigen::Matrix<double, 3, 2> origin, direction;
};
struct DifferentialTrace {
  RayStatus status = RayStatus::kMissesSurface;
  Ray exit;
  RayDifferential differential;
};
DifferentialTrace TraceDifferential(const Lens& lens, double index, const Ray& ray,
                                    const RayDifferential& in);

// Parallel rays, shifted along two directions across the ray.
RayDifferential ParallelDifferential(const Ray& ray);
// Vergence of the pencil that a differential spans, in air; infinite entries at its focus.
Eigen::Matrix3d VergenceOf(const Ray& ray, const RayDifferential& differential);

// Any two unit vectors across `direction` that make a right-handed triad (e1, e2, direction).
Eigen::Matrix<double, 3, 2> AcrossBasis(const Eigen::Vector3d& direction);

}  // namespace lorgnette
