// SPDX-License-Identifier: Apache-2.0
// Triangle models from files: glTF 2.0 (.gltf, .glb), Wavefront OBJ, PLY and STL.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/mesh.h"
#include "base/result.h"
#include "geometry/frame_model.h"

namespace lorgnette {

struct ModelPart {
  std::string name;
  TriangleMesh mesh;  // in the file's own unit and axes, node transforms applied
  FrameMaterial material;
  bool transparent = false;  // by transmission, alpha blending or opacity
};

struct ModelFile {
  std::vector<ModelPart> parts;
  std::optional<double> mm_per_unit;  // known for glTF (1000), otherwise absent
  std::vector<std::string> notes;     // what was left out: "materials left out: ..."
};

// By the file's extension. Every error names the file and what is wrong with it: a missing buffer,
// an index out of range, a number that is not finite, a file without triangles.
Result<ModelFile> ReadModelFile(const std::string& path);

// The same from bytes; `name` stands in errors. `folder` is where buffers, materials and pictures
// lie; OBJ without: materials are passed over.
Result<ModelFile> ParseObj(std::string_view text, const std::string& name,
                           const std::string& folder = "");
Result<ModelFile> ParsePly(std::string_view bytes, const std::string& name);
Result<ModelFile> ParseStl(std::string_view bytes, const std::string& name);
Result<ModelFile> ParseGltf(std::string_view bytes, const std::string& name,
                            const std::string& folder);

}  // namespace lorgnette
