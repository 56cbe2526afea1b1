// SPDX-License-Identifier: Apache-2.0
// Lenses as closed meshes in files: binary STL, and glTF 2.0 (.glb) with the material of the lens.
#pragma once

#include <string>
#include <vector>

#include "base/mesh.h"
#include "base/result.h"
#include "optics/design.h"

namespace lorgnette {

// The lens to its outline with a flat edge, lens frame, mm.
Result<TriangleMesh> MeshOf(const LensDesign& design);

// Little-endian, normals from the triangles, mm. A closed mesh stays closed: vertices that share a
// position share its bits.
std::string StlOf(const TriangleMesh& mesh, const std::string& title);

// One node a lens, in metres, +x to the wearer's left, +y up, +z out of the face; right and left
// lens `pd_mm` apart. Material: KHR_materials_transmission, _ior, _volume (thickness at the centre)
// and _dispersion (20 / V_d). The order and the surfaces stand in the node's `extras`.
struct GlbLens {
  const LensDesign* design = nullptr;
  std::string extras;  // a JSON object
};
Result<std::string> GlbOf(const std::vector<GlbLens>& lenses, double pd_mm);

}  // namespace lorgnette
