// SPDX-License-Identifier: Apache-2.0
// Vertices of a mesh that lie halfway between two of their neighbours, for what is computed a
// vertex and may be a mean there. Internal to render/.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh.h"

namespace lorgnette {

// `one` and `other` are neighbours of `vertex` and no middle vertices themselves; their mean is
// within a tenth of their distance of it, and the mean of their normals within 0.1 rad of its own.
struct MiddleVertex {
  std::uint32_t vertex, one, other;
};
// mesh with normals.
std::vector<MiddleVertex> MiddleVertices(const TriangleMesh& mesh);

}  // namespace lorgnette
