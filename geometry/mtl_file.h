// SPDX-License-Identifier: Apache-2.0
// Materials of Wavefront OBJ models (.mtl).
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "geometry/frame_material.h"

namespace lorgnette {

struct MtlMaterial {
  FrameMaterial surface;
  bool transparent = false;  // by opacity below 0.95
};

struct MtlFile {
  std::map<std::string, MtlMaterial> materials;
  std::vector<std::string> notes;  // pictures that could not be read
};

// Understood: newmtl, Kd, Ks, Ns, d, Tr, Ni, Pm, Pr, map_Kd; other keys are passed over. Colours
// are taken as linear, pictures as sRGB. Fails, naming file and line, where a number is none.
//   folder   where pictures lie; empty: they are passed over
Result<MtlFile> ParseMtl(std::string_view text, const std::string& name, const std::string& folder);

}  // namespace lorgnette
