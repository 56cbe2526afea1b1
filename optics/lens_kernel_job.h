// SPDX-License-Identifier: Apache-2.0
// What the dispatched code of the lens kernel is called with: surfaces as plain numbers.
#pragma once

#include <cstddef>

#include "optics/lens_kernel.h"

namespace lorgnette::kernel {

// One surface of the lens. The axes are unit vectors of the lens frame, so that a ground prism
// costs nothing: `a` along the surface's own +z, `g` along the generator meridian.
template <typename T>
struct FaceParams {
  bool torus = false;
  bool tilted = false;  // a is not (0, 0, 1)
  T vertex_z = 0;       // mm
  T c = 0;              // curvature: of the sphere, or of the torus across its generator, 1/mm
  T generator = 0;      // torus: curvature of the generator
  T delta = 0;          // torus: generator - c
  T ax = 0, ay = 0, az = 1;
  T gx = 0, gy = 0, gz = 0;
};

// Rays through `first` and, unless `face_only`, on through `second`.
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
