// SPDX-License-Identifier: Apache-2.0
// What the dispatched code of the lens kernel is called with: surfaces as plain numbers.
#pragma once

#include <array>
#include <cstddef>

#include "optics/lens_kernel.h"

// The kernel is inlined whole into its loops: a call would pass every vector through memory. The
// sanitizers guard each of those accesses, and thousands of inlined ones take minutes to compile.
#ifdef __SANITIZE_ADDRESS__
#define LORGNETTE_KERNEL_INLINE inline
#else
#define LORGNETTE_KERNEL_INLINE HWY_INLINE
#endif

namespace lorgnette::kernel {

enum class FaceKind { kSphere, kTorus, kConic, kProgressive, kAtoroid, kGrid };

// Chebyshev coefficients of the sag along a progressive corridor.
inline constexpr std::size_t kCorridorTerms = 24;

// One surface of the lens. The axes are unit vectors of the lens frame, so that a ground prism
// costs nothing: `a` along the surface's own +z, `g` along the generator or the umbilic, `u` across
// both.
template <typename T>
struct FaceParams {
  FaceKind kind = FaceKind::kSphere;
  bool tilted = false;  // a is not (0, 0, 1)
  T vertex_z = 0;       // mm
  T c = 0;              // 1/mm: of the sphere, of the torus across its generator, of the conic's
                        // vertex, of the progressive's far zone, mean one of atoroid and grid
  T generator = 0;      // torus: curvature of the generator, 1/mm
  T delta = 0;          // torus: generator - c
  T ax = 0, ay = 0, az = 1;
  T gx = 0, gy = 1, gz = 0;
  T ux = 1, uy = 0, uz = 0;
  T conic = 1;                               // conic: 1 + k
  std::array<T, 4> even{};                   // conic: a4, a6, a8, a10
  T add = 0, start = 0, length = 1;          // progressive: added curvature, 1/mm; mm
  T end_sine = 0;                            // sine of the umbilic's slope where the corridor ends
  T end_sag = 0;                             // sag where it ends, mm
  std::array<T, kCorridorTerms> corridor{};  // sag inside it, in u = (start - y) / length
  T across = 0, conic_across = 1;            // atoroid: curvature across, 1 + k there; `conic`,
                                             // `generator` and even[0] are the generator's
  T base = 0;                                // grid: curvature of the sphere beneath, 1/mm
  T x0 = 0, y0 = 0, per_x = 1, per_y = 1;    // grid: first node, mm; nodes a mm
  T nx = 0, ny = 0;                          // grid: nodes each way
  const T* coefficients = nullptr;           // grid: (nx + 2) x (ny + 2), x running fastest
};

template <typename T>
struct LensJob {
  FaceParams<T> first, second;
  T sense = 1;  // sign of normal . direction at the wanted crossings
  T index = 1;
  RayArrays<const T> in;
  std::size_t n = 0;
  LensBatchOutput<T> out;
};

template <typename T>
struct FaceJob {
  FaceParams<T> face;
  T sense = 1;
  T index = 1;
  RayArrays<const T> in;
  std::size_t n = 0;
  FaceBatchOutput<T> out;
};

}  // namespace lorgnette::kernel
