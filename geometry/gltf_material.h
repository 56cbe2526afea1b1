// SPDX-License-Identifier: Apache-2.0
// The materials of a glTF 2.0 model: metallic-roughness, transmission, index, and their textures.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "geometry/frame_material.h"

namespace tinygltf {
class Model;
}

namespace lorgnette {

struct GltfMaterial {
  std::string name;
  FrameMaterial surface;
  bool transparent = false;  // by transmission or alpha blending
  int uv_set = 0;            // TEXCOORD_n of its textures
};

// Each texture is decoded once and shared by the materials that use it.
class GltfMaterials {
 public:
  explicit GltfMaterials(const tinygltf::Model& gltf) : gltf_(gltf) {}
  // nullptr for an index that the file does not have.
  const GltfMaterial* Get(int index);

 private:
  std::shared_ptr<const Texture> TextureAt(int index);
  GltfMaterial Read(int index);

  const tinygltf::Model& gltf_;
  std::map<int, GltfMaterial> materials_;
  std::map<int, std::shared_ptr<const Texture>> textures_;
};

}  // namespace lorgnette
