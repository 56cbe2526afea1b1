// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_mesh_files.h"

#include <Eigen/Geometry>
#include <bit>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

#include "geometry/lens_mesh.h"
#include "optics/outline.h"

namespace lorgnette {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kStlTitle = 80;
constexpr double kMetres = 1e-3;
constexpr int kFloat = 5126, kUnsignedInt = 5125;           // glTF component types
constexpr int kVertexBuffer = 34962, kIndexBuffer = 34963;  // glTF buffer view targets
constexpr std::uint32_t kGlb = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr double kDispersionScale = 20;  // of KHR_materials_dispersion

// Files are little-endian, as this machine is.
template <typename T>
void Put(std::string& out, T value) {
  static_assert(std::endian::native == std::endian::little);
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}
void Put(std::string& out, const Eigen::Vector3f& v) {
  for (int i = 0; i < 3; ++i) Put(out, v[i]);
}

// A rotation by half a turn about y, and metres: glTF's axes from the lens frame.
Eigen::Vector3f GltfPoint(const Eigen::Vector3d& p) {
  return Eigen::Vector3d(-p.x() * kMetres, p.y() * kMetres, -p.z() * kMetres).cast<float>();
}

class GlbWriter {
 public:
  Status Add(const GlbLens& lens, double x_mm) {
    LG_ASSIGN(const TriangleMesh mesh, MeshOf(*lens.design));
    const int material = AddMaterial(*lens.design);
    Json attributes = {{"POSITION", AddPoints(mesh)}, {"NORMAL", AddNormals(mesh)}};
    const Json primitive = {
        {"attributes", attributes}, {"indices", AddTriangles(mesh)}, {"material", material}};
    meshes_.push_back(Json{{"primitives", Json::array({primitive})}});
    nodes_.push_back(
        Json{{"name", lens.design->order.eye == Eye::kRight ? "lens right" : "lens left"},
             {"mesh", meshes_.size() - 1},
             {"translation", {x_mm * kMetres, 0, 0}},
             {"extras", Json::parse(lens.extras)}});
    return {};
  }

  std::string Document() {
    Json scene_nodes = Json::array();
    for (std::size_t i = 0; i < nodes_.size(); ++i) scene_nodes.push_back(i);
    const Json json = {{"asset", {{"version", "2.0"}, {"generator", "lorgnette"}}},
                       {"extensionsUsed",
                        {"KHR_materials_transmission", "KHR_materials_ior", "KHR_materials_volume",
                         "KHR_materials_dispersion"}},
                       {"scene", 0},
                       {"scenes", Json::array({Json{{"nodes", scene_nodes}}})},
                       {"nodes", nodes_},
                       {"meshes", meshes_},
                       {"materials", materials_},
                       {"accessors", accessors_},
                       {"bufferViews", views_},
                       {"buffers", Json::array({Json{{"byteLength", binary_.size()}}})}};
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string out;
    Put(out, kGlb);
    Put(out, std::uint32_t{2});
    Put(out, std::uint32_t(12 + 8 + text.size() + 8 + binary_.size()));
    Put(out, std::uint32_t(text.size()));
    Put(out, kJsonChunk);
    out += text;
    Put(out, std::uint32_t(binary_.size()));
    Put(out, kBinaryChunk);
    return out + binary_;
  }

 private:
  // Every entry is four bytes wide: views stay aligned without padding.
  int AddView(const std::string& bytes, int target) {
    views_.push_back(Json{{"buffer", 0},
                          {"byteOffset", binary_.size()},
                          {"byteLength", bytes.size()},
                          {"target", target}});
    binary_ += bytes;
    return int(views_.size()) - 1;
  }
  int AddAccessor(Json accessor) {
    accessors_.push_back(std::move(accessor));
    return int(accessors_.size()) - 1;
  }
  int AddPoints(const TriangleMesh& mesh) {
    std::string bytes;
    Eigen::Vector3f low = GltfPoint(mesh.positions.front()), high = low;
    for (const Eigen::Vector3d& p : mesh.positions) {
      const Eigen::Vector3f q = GltfPoint(p);
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
      Put(bytes, q);
    }
    return AddAccessor({{"bufferView", AddView(bytes, kVertexBuffer)},
                        {"componentType", kFloat},
                        {"count", mesh.positions.size()},
                        {"type", "VEC3"},
                        {"min", {low.x(), low.y(), low.z()}},
                        {"max", {high.x(), high.y(), high.z()}}});
  }
  int AddNormals(const TriangleMesh& mesh) {
    std::string bytes;
    for (const Eigen::Vector3d& n : mesh.normals) {
      Put(bytes, Eigen::Vector3d(-n.x(), n.y(), -n.z()).normalized().cast<float>().eval());
    }
    return AddAccessor({{"bufferView", AddView(bytes, kVertexBuffer)},
                        {"componentType", kFloat},
                        {"count", mesh.normals.size()},
                        {"type", "VEC3"}});
  }
  int AddTriangles(const TriangleMesh& mesh) {
    std::string bytes;
    for (const Eigen::Vector3i& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) Put(bytes, std::uint32_t(t[k]));
    }
    return AddAccessor({{"bufferView", AddView(bytes, kIndexBuffer)},
                        {"componentType", kUnsignedInt},
                        {"count", 3 * mesh.triangles.size()},
                        {"type", "SCALAR"}});
  }
  int AddMaterial(const LensDesign& design) {
    const Medium& medium = design.lens.medium;
    const double thickness = design.lens.center_thickness_mm * kMetres;
    const Json extensions = {
        {"KHR_materials_transmission", Json{{"transmissionFactor", 1}}},
        {"KHR_materials_ior", Json{{"ior", medium.index_d}}},
        {"KHR_materials_volume", Json{{"thicknessFactor", thickness}}},
        {"KHR_materials_dispersion", Json{{"dispersion", kDispersionScale / medium.abbe}}}};
    materials_.push_back(
        Json{{"name", medium.name},
             {"pbrMetallicRoughness", Json{{"baseColorFactor", Json::array({1, 1, 1, 1})},
                                           {"metallicFactor", 0},
                                           {"roughnessFactor", 0}}},
             {"extensions", extensions}});
    return int(materials_.size()) - 1;
  }

  std::string binary_;
  Json nodes_ = Json::array(), meshes_ = Json::array(), materials_ = Json::array(),
       accessors_ = Json::array(), views_ = Json::array();
};

}  // namespace

Result<TriangleMesh> MeshOf(const LensDesign& design) {
  const LensOrder& order = design.order;
  return BuildLensMesh(
      design.lens,
      order.contour_mm.empty() ? Outline::Round(order.diameter_mm).rim() : order.contour_mm, {});
}

std::string StlOf(const TriangleMesh& mesh, const std::string& title) {
  std::string out = title.substr(0, kStlTitle);
  out.resize(kStlTitle, ' ');
  Put(out, std::uint32_t(mesh.triangles.size()));
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.positions[std::size_t(t[0])],
                          &b = mesh.positions[std::size_t(t[1])],
                          &c = mesh.positions[std::size_t(t[2])];
    Put(out, (b - a).cross(c - a).normalized().cast<float>().eval());
    for (const Eigen::Vector3d* p : {&a, &b, &c}) Put(out, p->cast<float>().eval());
    Put(out, std::uint16_t{0});
  }
  return out;
}

Result<std::string> GlbOf(const std::vector<GlbLens>& lenses, double pd_mm) {
  GlbWriter writer;
  for (const GlbLens& lens : lenses) {
    const double x = lenses.size() < 2 ? 0 : 0.5 * pd_mm;
    LG_RETURN_IF_ERROR(writer.Add(lens, lens.design->order.eye == Eye::kRight ? -x : x));
  }
  return writer.Document();
}

}  // namespace lorgnette
