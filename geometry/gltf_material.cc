// SPDX-License-Identifier: Apache-2.0
#include "geometry/gltf_material.h"

#include <tiny_gltf.h>

#include <algorithm>

namespace lorgnette {
namespace {

constexpr double kSeenThrough = 0.05;  // a transmission beyond this makes a part transparent
constexpr double kOpaque = 0.95;       // and a coverage below this, where it is blended

// A number of an extension of a material.
double Extra(const tinygltf::Material& from, const char* extension, const char* key,
             double otherwise) {
  const auto found = from.extensions.find(extension);
  if (found == from.extensions.end() || !found->second.Has(key)) return otherwise;
  const tinygltf::Value& value = found->second.Get(key);
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

float Share(double value) { return value >= 0 ? float(std::min(value, 1.0)) : 0.0f; }

}  // namespace

std::shared_ptr<const Texture> GltfMaterials::TextureAt(int index) {
  if (index < 0 || std::size_t(index) >= gltf_.textures.size()) return nullptr;
  const auto known = textures_.find(index);
  if (known != textures_.end()) return known->second;
  const tinygltf::Texture& from = gltf_.textures[std::size_t(index)];
  std::shared_ptr<Texture> texture;
  if (from.source >= 0 && std::size_t(from.source) < gltf_.images.size()) {
    const tinygltf::Image& image = gltf_.images[std::size_t(from.source)];
    const std::size_t bytes = image.bits == 16 ? 2 : 1;
    const std::size_t channels = std::size_t(std::max(image.component, 0));
    const std::size_t pixels =
        std::size_t(std::max(image.width, 0)) * std::size_t(std::max(image.height, 0));
    if (pixels > 0 && channels > 0 && image.image.size() >= pixels * channels * bytes) {
      texture = std::make_shared<Texture>();
      texture->image = ImageRgba8(image.width, image.height);
      for (std::size_t i = 0; i < pixels; ++i) {
        // The high byte of 16 bits comes second.
        const auto at = [&](std::size_t k) {
          return image.image[(i * channels + k) * bytes + bytes - 1];
        };
        std::uint8_t* to = texture->image.data.data() + 4 * i;
        const bool grey = channels < 3;
        for (std::size_t k = 0; k < 3; ++k) to[k] = at(grey ? 0 : k);
        to[3] = channels == 4 ? at(3) : channels == 2 ? at(1) : 255;
      }
      if (from.sampler >= 0 && std::size_t(from.sampler) < gltf_.samplers.size()) {
        const tinygltf::Sampler& sampler = gltf_.samplers[std::size_t(from.sampler)];
        texture->clamp_u = sampler.wrapS == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
        texture->clamp_v = sampler.wrapT == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
      }
    }
  }
  textures_[index] = texture;
  return texture;
}

GltfMaterial GltfMaterials::Read(int index) {
  const tinygltf::Material& from = gltf_.materials[std::size_t(index)];
  const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
  GltfMaterial material;
  material.name = from.name;
  PbrMaterial to;
  if (pbr.baseColorFactor.size() == 4) {
    for (int k = 0; k < 3; ++k) to.base_color[k] = Share(pbr.baseColorFactor[std::size_t(k)]);
    to.alpha = Share(pbr.baseColorFactor[3]);
  }
  to.metallic = Share(pbr.metallicFactor);
  to.roughness = Share(pbr.roughnessFactor);
  to.transmission = Share(Extra(from, "KHR_materials_transmission", "transmissionFactor", 0));
  to.ior = float(std::clamp(Extra(from, "KHR_materials_ior", "ior", 1.5), 1.0, 4.0));
  to.double_sided = from.doubleSided;
  to.base_color_texture = TextureAt(pbr.baseColorTexture.index);
  to.metallic_roughness_texture = TextureAt(pbr.metallicRoughnessTexture.index);
  to.normal_texture = TextureAt(from.normalTexture.index);
  to.normal_scale = float(from.normalTexture.scale);
  const auto transmission = from.extensions.find("KHR_materials_transmission");
  if (transmission != from.extensions.end() && transmission->second.Has("transmissionTexture")) {
    const tinygltf::Value& texture = transmission->second.Get("transmissionTexture");
    if (texture.IsObject() && texture.Has("index") && texture.Get("index").IsNumber()) {
      to.transmission_texture = TextureAt(texture.Get("index").GetNumberAsInt());
    }
  }
  material.uv_set = to.base_color_texture           ? pbr.baseColorTexture.texCoord
                    : to.metallic_roughness_texture ? pbr.metallicRoughnessTexture.texCoord
                                                    : from.normalTexture.texCoord;
  material.transparent = double(to.transmission) > kSeenThrough ||
                         (from.alphaMode == "BLEND" && double(to.alpha) < kOpaque);
  // Coverage means something only where the file asks for blending.
  if (from.alphaMode != "BLEND" && from.alphaMode != "MASK") to.alpha = 1;
  material.surface = PhongLike(std::move(to));
  return material;
}

const GltfMaterial* GltfMaterials::Get(int index) {
  if (index < 0 || std::size_t(index) >= gltf_.materials.size()) return nullptr;
  const auto known = materials_.find(index);
  if (known != materials_.end()) return &known->second;
  return &(materials_[index] = Read(index));
}

}  // namespace lorgnette
