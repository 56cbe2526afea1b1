// SPDX-License-Identifier: Apache-2.0
#include "geometry/model_file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "base/atomic_file.h"

namespace lorgnette {
namespace {

Status CheckModel(const ModelFile& model, const std::string& name) {
  bool any = false;
  for (const ModelPart& part : model.parts) {
    const int count = int(part.mesh.positions.size());
    for (const Eigen::Vector3d& p : part.mesh.positions) {
      if (!p.allFinite())
        return Failure(name + ":" + part.name + ": got a point that is not finite");
    }
    for (const Eigen::Vector3i& t : part.mesh.triangles) {
      any = true;
      if (t.minCoeff() < 0 || t.maxCoeff() >= count) {
        return Failure(name + ":" + part.name + ": got a triangle that names point " +
                       std::to_string(t.maxCoeff()) + ", want 0.." + std::to_string(count - 1));
      }
    }
  }
  if (!any) return Failure(name + ": got no triangles, want a mesh");
  return {};
}

}  // namespace

Result<ModelFile> ReadModelFile(const std::string& path) {
  const std::filesystem::path file(path);
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  const bool gltf = extension == ".gltf" || extension == ".glb";
  if (!gltf && extension != ".obj" && extension != ".ply" && extension != ".stl") {
    return UsageError(path + ": got a file of type \"" + extension +
                      "\", want .glb, .gltf, .obj, .ply or .stl");
  }
  LG_ASSIGN(const std::string bytes, ReadFile(path));
  const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
  Result<ModelFile> model = gltf                  ? ParseGltf(bytes, path, folder)
                            : extension == ".obj" ? ParseObj(bytes, path, folder)
                            : extension == ".ply" ? ParsePly(bytes, path)
                                                  : ParseStl(bytes, path);
  if (model) LG_RETURN_IF_ERROR(CheckModel(*model, path));
  return model;
}

}  // namespace lorgnette
