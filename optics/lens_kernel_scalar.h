// SPDX-License-Identifier: Apache-2.0
// The lens kernel's answers by the scalar path: for surfaces that have no SIMD form.
#pragma once

#include <cstddef>

#include "optics/lens_kernel.h"

namespace lorgnette::kernel {

// Same contract as TraceLensBatch and TraceFaceBatch. T is float or double.
template <typename T>
void TraceLensScalar(const Lens& lens, double index, const RayArrays<const T>& in, std::size_t n,
                     const LensBatchOutput<T>& out);
template <typename T>
void TraceFaceScalar(const Lens& lens, LensFace face, double index, const RayArrays<const T>& in,
                     std::size_t n, const FaceBatchOutput<T>& out);

}  // namespace lorgnette::kernel
