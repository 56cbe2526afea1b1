// SPDX-License-Identifier: Apache-2.0
// A head behind the face: the tracked mesh ends before the ears, so skull and ears are continued
// from its outline, to hide the temples where a real head would.
#pragma once

#include "base/mesh.h"
#include "geometry/fit.h"

namespace lorgnette {

// Head space. Skull: the face's outer boundary drawn back to a rounded occiput, closed by a cap
// behind the face. Ears: flat shells that stand off the skull from the ears' upper roots, so that a
// temple passes between ear and head and its tip vanishes behind the ear. All closed, with normals.
// A face without boundary (a whole head) needs none: the result is empty.
// Never in front of the face: tested along +z.
TriangleMesh BuildHeadOccluder(const TriangleMesh& face, const EarPoints& ears);

// The longest closed boundary of an open mesh, as vertex indices in order; empty without boundary.
std::vector<int> LongestBoundary(const TriangleMesh& mesh);

}  // namespace lorgnette
