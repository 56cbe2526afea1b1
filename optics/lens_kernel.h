// SPDX-License-Identifier: Apache-2.0
// Batches of rays through a lens by SIMD (Highway, dispatched at run time): what the compositor
// calls for every lens pixel. Agrees with TraceThrough (optics/trace.h) within the bounds below.
// Surfaces without a SIMD form take the scalar path behind the same functions.
//
// Everything is in the lens frame (optics/ray.h), mm. Arrays need no alignment and no padding: a
// ragged tail is handled inside. No NaN comes back, whatever goes in: each ray has a status.
// Rays that reach a torus within about 1e-6 of grazing may be reported as kMissesSurface where
// TraceThrough still finds the crossing by bisection.
#pragma once

#include <cstddef>
#include <cstdint>

#include "optics/lens.h"

namespace lorgnette {

// Structure of arrays of n rays. Also used for hits: point in ox..oz, unit normal in dx..dz.
template <typename T>
struct RayArrays {
  T *ox, *oy, *oz;  // origin, mm
  T *dx, *dy, *dz;  // unit direction
};

// What TraceLensBatch writes; everything behind a null pointer is skipped. No array may overlap
// the input. A surface that was not reached leaves zeros.
template <typename T>
struct LensBatchOutput {
  RayArrays<T> exit;                // refracted ray, origin on the second surface; zero unless kOk
  std::uint8_t* status;             // RayStatus, n of them
  RayArrays<T>* first = nullptr;    // point and normal (toward +z) on the first surface
  RayArrays<T>* inside = nullptr;   // point on the SECOND surface, direction inside the lens; also
                                    // set on total reflection there
  RayArrays<T>* second = nullptr;   // dx..dz: normal (toward +z) at that point; ox..oz untouched
  T* first_reflectance = nullptr;   // unpolarised Fresnel, entering; 0 where not reached
  T* second_reflectance = nullptr;  // the same inside at the second surface; 1 on total reflection
};

// Refracts n rays through both surfaces. The sign of the first ray's dz says which surface comes
// first; a ray that travels the other way is reported as kMissesSurface.
//   index  of the medium; the world and the eye's side are air
void TraceLensBatch(const Lens& lens, double index, const RayArrays<const float>& in, std::size_t n,
                    const LensBatchOutput<float>& out);
void TraceLensBatch(const Lens& lens, double index, const RayArrays<const double>& in,
                    std::size_t n, const LensBatchOutput<double>& out);

// One step of a chain of reflections inside the lens.
enum class LensFace { kFront, kBack };
template <typename T>
struct FaceBatchOutput {
  RayArrays<T> hit;      // point and normal (toward +z) on the face; zero on kMissesSurface
  std::uint8_t* status;  // RayStatus; on kTotalInternalReflection all but `refracted` is set
  RayArrays<T>* refracted = nullptr;  // dx..dz: direction outside the lens, zero unless kOk;
                                      // ox..oz untouched (the point is hit's)
  RayArrays<T>* reflected = nullptr;  // dx..dz: mirror direction, inside; ox..oz untouched
  T* reflectance = nullptr;           // unpolarised Fresnel; 1 on total reflection, 0 on a miss
};

// Rays inside the glass (origins in it or on the other face) to where they leave through `face`:
// only crossings outward and at a positive distance count. `in` may be the arrays that an earlier
// step returned: {inside.ox, inside.oy, inside.oz, reflected.dx, ...}.
void TraceFaceBatch(const Lens& lens, LensFace face, double index, const RayArrays<const float>& in,
                    std::size_t n, const FaceBatchOutput<float>& out);
void TraceFaceBatch(const Lens& lens, LensFace face, double index,
                    const RayArrays<const double>& in, std::size_t n,
                    const FaceBatchOutput<double>& out);

// The instruction set that this machine runs the kernel with: "AVX3", "AVX2", "SSE4", ...
const char* LensKernelTarget();

// Worst deviation from a long double trace of the same rays over the lenses and rays of
// tests/optics/lens_kernel_test.cc (rays up to 80 degrees of incidence).
inline constexpr double kLensKernelFloatPositionError_mm = 1e-4;
inline constexpr double kLensKernelDoublePositionError_mm = 1e-11;

}  // namespace lorgnette
