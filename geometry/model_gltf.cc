// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 through tinygltf: node tree, triangles, base colour, metal and roughness, transmission.
// Base-colour textures count by their mean colour.
#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>

#include "geometry/model_file.h"

namespace lorgnette {
namespace {

constexpr int kMaxNodeDepth = 64;

float LinearFromSrgb(float c) {
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

class GltfReader {
 public:
  GltfReader(const tinygltf::Model& gltf, const std::string& name) : gltf_(gltf), name_(name) {}

  Result<ModelFile> Read() {
    model_.mm_per_unit = 1000;
    std::vector<int> roots;
    const int scene = std::max(0, gltf_.defaultScene);
    if (std::size_t(scene) < gltf_.scenes.size()) {
      roots = gltf_.scenes[std::size_t(scene)].nodes;
    } else {
      for (std::size_t i = 0; i < gltf_.nodes.size(); ++i) roots.push_back(int(i));
    }
    for (const int root : roots) {
      LG_RETURN_IF_ERROR(Visit(root, Eigen::Affine3d::Identity(), 0));
    }
    return std::move(model_);
  }

 private:
  tl::unexpected<Error> Bad(const std::string& what) const { return Failure(name_ + ": " + what); }

  static Eigen::Affine3d TransformOf(const tinygltf::Node& node) {
    Eigen::Affine3d t = Eigen::Affine3d::Identity();
    if (node.matrix.size() == 16) {
      t.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
      return t;
    }
    if (node.translation.size() == 3) {
      t.translate(Eigen::Vector3d(node.translation[0], node.translation[1], node.translation[2]));
    }
    if (node.rotation.size() == 4) {
      t.rotate(
          Eigen::Quaterniond(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2])
              .normalized());
    }
    if (node.scale.size() == 3) {
      t.scale(Eigen::Vector3d(node.scale[0], node.scale[1], node.scale[2]));
    }
    return t;
  }

  Status Visit(int index, const Eigen::Affine3d& parent, int depth) {
    if (index < 0 || std::size_t(index) >= gltf_.nodes.size() || depth > kMaxNodeDepth) {
      return Bad("got a node tree with a node out of range or a loop");
    }
    const tinygltf::Node& node = gltf_.nodes[std::size_t(index)];
    const Eigen::Affine3d here = parent * TransformOf(node);
    if (node.mesh >= 0) {
      if (std::size_t(node.mesh) >= gltf_.meshes.size()) return Bad("got a mesh out of range");
      const tinygltf::Mesh& mesh = gltf_.meshes[std::size_t(node.mesh)];
      for (const tinygltf::Primitive& primitive : mesh.primitives) {
        LG_RETURN_IF_ERROR(
            ReadPrimitive(primitive, here, node.name.empty() ? mesh.name : node.name));
      }
    }
    for (const int child : node.children) LG_RETURN_IF_ERROR(Visit(child, here, depth + 1));
    return {};
  }

  // Start of an accessor's data and the bytes from one item to the next; nullptr when it does not
  // lie inside its buffer.
  const unsigned char* Data(const tinygltf::Accessor& accessor, std::size_t& stride) const {
    if (accessor.bufferView < 0 || std::size_t(accessor.bufferView) >= gltf_.bufferViews.size()) {
      return nullptr;
    }
    const tinygltf::BufferView& view = gltf_.bufferViews[std::size_t(accessor.bufferView)];
    if (view.buffer < 0 || std::size_t(view.buffer) >= gltf_.buffers.size()) return nullptr;
    const auto& bytes = gltf_.buffers[std::size_t(view.buffer)].data;
    const int step = accessor.ByteStride(view);
    const int component = tinygltf::GetComponentSizeInBytes(std::uint32_t(accessor.componentType));
    const int components = tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type));
    if (step <= 0 || component <= 0 || components <= 0) return nullptr;
    stride = std::size_t(step);
    const std::size_t start = view.byteOffset + accessor.byteOffset;
    const std::size_t item = std::size_t(component) * std::size_t(components);
    if (start > bytes.size() || accessor.count > bytes.size()) return nullptr;
    if (accessor.count > 0 && start + (accessor.count - 1) * stride + item > bytes.size()) {
      return nullptr;
    }
    return bytes.data() + start;
  }

  Result<std::vector<Eigen::Vector3d>> Vectors(int index) const {
    if (index < 0 || std::size_t(index) >= gltf_.accessors.size()) {
      return Bad("got an accessor out of range");
    }
    const tinygltf::Accessor& accessor = gltf_.accessors[std::size_t(index)];
    std::size_t stride = 0;
    const unsigned char* data = Data(accessor, stride);
    if (data == nullptr || accessor.type != TINYGLTF_TYPE_VEC3 ||
        accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
      return Bad("got positions or normals that are no floats in their buffer");
    }
    std::vector<Eigen::Vector3d> vectors(accessor.count);
    for (std::size_t i = 0; i < accessor.count; ++i) {
      float v[3];
      std::memcpy(v, data + i * stride, sizeof v);
      vectors[i] = {v[0], v[1], v[2]};
    }
    return vectors;
  }

  Result<std::vector<int>> Indices(int index, std::size_t points) const {
    std::vector<int> indices;
    if (index < 0) {
      for (std::size_t i = 0; i < points; ++i) indices.push_back(int(i));
      return indices;
    }
    if (std::size_t(index) >= gltf_.accessors.size()) return Bad("got indices out of range");
    const tinygltf::Accessor& accessor = gltf_.accessors[std::size_t(index)];
    std::size_t stride = 0;
    const unsigned char* data = Data(accessor, stride);
    const int size = tinygltf::GetComponentSizeInBytes(std::uint32_t(accessor.componentType));
    if (data == nullptr || accessor.type != TINYGLTF_TYPE_SCALAR || size > 4) {
      return Bad("got indices that do not lie in their buffer");
    }
    for (std::size_t i = 0; i < accessor.count; ++i) {
      std::uint32_t value = 0;
      std::memcpy(&value, data + i * stride, std::size_t(size));
      if (value >= points)
        return Bad("got an index of " + std::to_string(value) + ", want less than " +
                   std::to_string(points));
      indices.push_back(int(value));
    }
    return indices;
  }

  Status ReadPrimitive(const tinygltf::Primitive& primitive, const Eigen::Affine3d& transform,
                       const std::string& part_name) {
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != -1) return {};
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) return {};
    ModelPart part;
    part.name = part_name;
    LG_ASSIGN(part.mesh.positions, Vectors(position->second));
    LG_ASSIGN(const std::vector<int> indices,
              Indices(primitive.indices, part.mesh.positions.size()));
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      part.mesh.triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
    }
    const auto normal = primitive.attributes.find("NORMAL");
    if (normal != primitive.attributes.end()) {
      LG_ASSIGN(part.mesh.normals, Vectors(normal->second));
    }
    for (Eigen::Vector3d& p : part.mesh.positions) p = transform * p;
    const Eigen::Matrix3d turn = transform.linear().inverse().transpose();
    for (Eigen::Vector3d& n : part.mesh.normals) n = (turn * n).normalized();
    if (transform.linear().determinant() < 0) {
      for (Eigen::Vector3i& t : part.mesh.triangles) std::swap(t[1], t[2]);
    }
    bool good = part.mesh.normals.size() == part.mesh.positions.size();
    for (const Eigen::Vector3d& n : part.mesh.normals) good = good && n.allFinite();
    if (!good) ComputeVertexNormals(part.mesh);
    if (primitive.material >= 0 && std::size_t(primitive.material) < gltf_.materials.size()) {
      ReadMaterial(gltf_.materials[std::size_t(primitive.material)], part);
    }
    model_.parts.push_back(std::move(part));
    return {};
  }

  Eigen::Vector3f MeanColour(int texture) const {
    const Eigen::Vector3f white(1, 1, 1);
    if (texture < 0 || std::size_t(texture) >= gltf_.textures.size()) return white;
    const int source = gltf_.textures[std::size_t(texture)].source;
    if (source < 0 || std::size_t(source) >= gltf_.images.size()) return white;
    const tinygltf::Image& image = gltf_.images[std::size_t(source)];
    if (image.bits != 8 || image.component < 3 || image.image.empty()) return white;
    const std::size_t step = std::size_t(image.component);
    Eigen::Vector3d sum(0, 0, 0);
    const std::size_t pixels = image.image.size() / step;
    for (std::size_t i = 0; i < pixels; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        sum[int(k)] += double(LinearFromSrgb(float(image.image[i * step + k]) / 255.0f));
      }
    }
    return (sum / double(std::max<std::size_t>(1, pixels))).cast<float>();
  }

  void ReadMaterial(const tinygltf::Material& from, ModelPart& part) const {
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    Eigen::Vector3f base = MeanColour(pbr.baseColorTexture.index);
    double alpha = 1;
    if (pbr.baseColorFactor.size() == 4) {
      for (int k = 0; k < 3; ++k) base[k] *= float(pbr.baseColorFactor[std::size_t(k)]);
      alpha = pbr.baseColorFactor[3];
    }
    // Phong from metal and roughness: the reflected share of a dielectric is 0.04; the lobe is as
    // wide as that of roughness squared (exponent 2 / a^2 - 2).
    const float metal = std::clamp(float(pbr.metallicFactor), 0.0f, 1.0f);
    const float a = std::clamp(float(pbr.roughnessFactor * pbr.roughnessFactor), 0.03f, 1.0f);
    part.material.diffuse = base * (1 - metal) + base * (0.25f * metal);
    part.material.specular =
        Eigen::Vector3f::Constant(0.04f * (1 - metal)) + base * (0.75f * metal);
    part.material.shininess = std::clamp(2 / (a * a) - 2, 1.0f, 1000.0f);
    const auto transmission = from.extensions.find("KHR_materials_transmission");
    if (transmission != from.extensions.end() && transmission->second.Has("transmissionFactor")) {
      part.transparent = transmission->second.Get("transmissionFactor").GetNumberAsDouble() > 0.05;
    }
    part.transparent = part.transparent || (from.alphaMode == "BLEND" && alpha < 0.95);
    part.name += part.name.empty() || from.name.empty() ? from.name : " " + from.name;
  }

  const tinygltf::Model& gltf_;
  std::string name_;
  ModelFile model_;
};

}  // namespace

Result<ModelFile> ParseGltf(std::string_view bytes, const std::string& name,
                            const std::string& folder) {
  tinygltf::Model gltf;
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  bool read = false;
  try {
    if (bytes.substr(0, 4) == "glTF") {
      read = loader.LoadBinaryFromMemory(&gltf, &error, &warning,
                                         reinterpret_cast<const unsigned char*>(bytes.data()),
                                         unsigned(bytes.size()), folder);
    } else {
      read = loader.LoadASCIIFromString(&gltf, &error, &warning, bytes.data(),
                                        unsigned(bytes.size()), folder);
    }
    if (read) return GltfReader(gltf, name).Read();
  } catch (const std::exception& thrown) {
    error = thrown.what();
  }
  error = error.substr(0, error.find('\n'));
  return Failure(name + ": " + (error.empty() ? "got no readable glTF" : error));
}

}  // namespace lorgnette
