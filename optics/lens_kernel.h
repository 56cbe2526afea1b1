// SPDX-License-Identifier: Apache-2.0
// Batches of rays through a lens by SIMD (Highway, dispatched at run time): what the compositor
// calls for every lens pixel. Agrees with TraceThrough within the bounds stated below.
#pragma once

#include <cstddef>
#include <cstdint>

#include "optics/lens.h"

namespace lorgnette {

// Structure of arrays of n rays, in the lens frame. Arrays need no alignment.
template <typename T>
struct RayArrays {
  T *ox, *oy, *oz;  // origin, mm
  T *dx, *dy, *dz;  // unit direction
};

// Refracts n rays through both surfaces (the sign of dz says which comes first; all rays of one
// call travel the same way). Origins of `out` lie on the second surface. `first_normal`, when
// given, receives the unit normal (toward +z) and `first_point` the point at the first surface;
// `out_normal` the normal at the second. status[i] is a RayStatus; out is zero unless kOk.
template <typename T>
struct LensBatchOutput {
  RayArrays<T> exit;
  std::uint8_t* status;
  RayArrays<T>* first = nullptr;   // ox..oz point, dx..dz normal of the first surface
  RayArrays<T>* inside = nullptr;  // ox..oz point on the SECOND surface, dx..dz inside direction
  RayArrays<T>* second = nullptr;  // dx..dz normal of the second surface; ox..oz untouched
};
void TraceLensBatch(const Lens& lens, double index, const RayArrays<const float>& in, std::size_t n,
                    const LensBatchOutput<float>& out);
void TraceLensBatch(const Lens& lens, double index, const RayArrays<const double>& in,
                    std::size_t n, const LensBatchOutput<double>& out);

// Worst deviation from TraceThrough over the lenses of tests/optics/lens_kernel_test.cc.
inline constexpr double kLensKernelFloatPositionError_mm = 1e-4;
inline constexpr double kLensKernelDoublePositionError_mm = 1e-11;

}  // namespace lorgnette
