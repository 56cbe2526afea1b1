// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 through tinygltf: node tree, triangles, texture coordinates; materials beside
// (geometry/gltf_material.h).
#include <fmt/format.h>
#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>

#include "geometry/gltf_material.h"
#include "geometry/model_file.h"
#include "geometry/texture_file.h"

namespace lorgnette {
namespace {

constexpr int kMaxNodeDepth = 64;

class GltfReader {
 public:
  GltfReader(const tinygltf::Model& gltf, const std::string& name)
      : gltf_(gltf), name_(name), materials_(gltf) {}

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
    for (Eigen::Vector3d& p : part.mesh.positions) {
      p = transform * p;
      if (!p.allFinite()) return Bad("got a position that is not finite");
    }
    const Eigen::Matrix3d turn = transform.linear().inverse().transpose();
    for (Eigen::Vector3d& n : part.mesh.normals) n = (turn * n).normalized();
    if (transform.linear().determinant() < 0) {
      for (Eigen::Vector3i& t : part.mesh.triangles) std::swap(t[1], t[2]);
    }
    bool good = part.mesh.normals.size() == part.mesh.positions.size();
    for (const Eigen::Vector3d& n : part.mesh.normals) good = good && n.allFinite();
    if (!good) ComputeVertexNormals(part.mesh);
    LG_RETURN_IF_ERROR(ReadMaterial(primitive, part));
    model_.parts.push_back(std::move(part));
    return {};
  }

  // Texture coordinates: floats, or whole numbers that stand for 0..1.
  Result<std::vector<Eigen::Vector2f>> Uvs(int index) const {
    if (index < 0 || std::size_t(index) >= gltf_.accessors.size()) {
      return Bad("got an accessor out of range");
    }
    const tinygltf::Accessor& accessor = gltf_.accessors[std::size_t(index)];
    std::size_t stride = 0;
    const unsigned char* data = Data(accessor, stride);
    if (data == nullptr || accessor.type != TINYGLTF_TYPE_VEC2) {
      return Bad("got texture coordinates that do not lie in their buffer");
    }
    std::vector<Eigen::Vector2f> uvs(accessor.count);
    for (std::size_t i = 0; i < accessor.count; ++i) {
      const unsigned char* from = data + i * stride;
      switch (accessor.componentType) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
          std::memcpy(uvs[i].data(), from, 2 * sizeof(float));
          break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
          uvs[i] = Eigen::Vector2f(float(from[0]), float(from[1])) / 255.0f;
          break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
          uvs[i] = Eigen::Vector2f(float(from[0] + 256 * from[1]), float(from[2] + 256 * from[3])) /
                   65535.0f;
          break;
        default:
          return Bad("got texture coordinates that are neither floats nor whole numbers");
      }
    }
    return uvs;
  }

  Status ReadMaterial(const tinygltf::Primitive& primitive, ModelPart& part) {
    const GltfMaterial* material = materials_.Get(primitive.material);
    if (material == nullptr) return {};
    part.material = material->surface;
    part.transparent = material->transparent;
    part.name +=
        part.name.empty() || material->name.empty() ? material->name : " " + material->name;
    const auto uv = primitive.attributes.find("TEXCOORD_" + std::to_string(material->uv_set));
    if (uv == primitive.attributes.end()) return {};
    LG_ASSIGN(part.mesh.uvs, Uvs(uv->second));
    const bool good = part.mesh.uvs.size() == part.mesh.positions.size() &&
                      std::all_of(part.mesh.uvs.begin(), part.mesh.uvs.end(),
                                  [](const Eigen::Vector2f& p) { return p.allFinite(); });
    if (!good) part.mesh.uvs.clear();
    return {};
  }

  const tinygltf::Model& gltf_;
  std::string name_;
  GltfMaterials materials_;
  ModelFile model_;
};

// tinygltf's own loader of pictures does not look whether the view that holds one ends before its
// buffer does. `user` is the model that is being read.
bool LoadPicture(tinygltf::Image* image, int index, std::string* error, std::string* warning,
                 int width, int height, const unsigned char* bytes, int size, void* user) {
  const auto& gltf = *static_cast<const tinygltf::Model*>(user);
  bool fits = size > 0;
  if (fits && image->bufferView >= 0) {
    const tinygltf::BufferView& view = gltf.bufferViews[std::size_t(image->bufferView)];
    const std::size_t all = gltf.buffers[std::size_t(view.buffer)].data.size();
    fits = view.byteOffset <= all && view.byteLength <= all - view.byteOffset;
  }
  if (!fits || !PictureFits({reinterpret_cast<const char*>(bytes), std::size_t(size)})) {
    *error += fmt::format("image {} reaches beyond its bytes\n", index);
    return false;
  }
  return tinygltf::LoadImageData(image, index, error, warning, width, height, bytes, size, nullptr);
}

}  // namespace

Result<ModelFile> ParseGltf(std::string_view bytes, const std::string& name,
                            const std::string& folder) {
  tinygltf::Model gltf;
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(LoadPicture, &gltf);
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
