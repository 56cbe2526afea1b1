// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ: v, vn, vt, f (any polygon, negative indices), o, g, usemtl, mtllib.
#include <array>
#include <charconv>
#include <filesystem>
#include <map>

#include "base/atomic_file.h"
#include "geometry/model_file.h"
#include "geometry/mtl_file.h"
#include "geometry/text_line.h"

namespace lorgnette {
namespace {

class ObjParser {
 public:
  ObjParser(const std::string& name, const std::string& folder) : name_(name), folder_(folder) {
    Begin();
  }

  Status Line(std::string_view line, long number) {
    const std::string_view key = NextWord(line);
    if (key == "v") return ReadPoint(line, points_, number);
    if (key == "vt") return ReadUv(line, number);
    if (key == "mtllib") return ReadLibrary(line);
    if (key == "vn") return ReadPoint(line, normals_, number);
    if (key == "f") return ReadFace(line, number);
    if (key == "o" || key == "g") {
      object_ = std::string(RestOf(line));
      Begin();
    } else if (key == "usemtl") {
      material_ = std::string(RestOf(line));
      Begin();
    }
    return {};
  }
  ModelFile Finish() {
    std::erase_if(model_.parts, [](const ModelPart& part) { return part.mesh.empty(); });
    for (ModelPart& part : model_.parts) {
      // A part of which some corners have none is without.
      if (part.mesh.normals.size() != part.mesh.positions.size()) ComputeVertexNormals(part.mesh);
      if (part.mesh.uvs.size() != part.mesh.positions.size()) part.mesh.uvs.clear();
    }
    return std::move(model_);
  }

 private:
  void Begin() {
    if (model_.parts.empty() || !model_.parts.back().mesh.empty()) model_.parts.emplace_back();
    ModelPart& part = model_.parts.back();
    part.name = material_.empty() ? object_ : object_ + " " + material_;
    const auto known = materials_.find(material_);
    part.material = known == materials_.end() ? FrameMaterial{} : known->second.surface;
    part.transparent = known != materials_.end() && known->second.transparent;
    corners_.clear();
  }
  // A missing library is told; the model is read without.
  Status ReadLibrary(std::string_view line) {
    if (folder_.empty()) return {};
    const std::string path = (std::filesystem::path(folder_) / RestOf(line)).string();
    const Result<std::string> text = ReadFile(path);
    if (!text) {
      model_.notes.push_back("materials left out: " + text.error().message);
      return {};
    }
    LG_ASSIGN(MtlFile file, ParseMtl(*text, path, folder_));
    materials_.merge(file.materials);
    model_.notes.insert(model_.notes.end(), file.notes.begin(), file.notes.end());
    return {};
  }
  tl::unexpected<Error> Bad(long number, const std::string& what) const {
    return Failure(name_ + ":" + std::to_string(number) + ": " + what);
  }
  Status ReadPoint(std::string_view line, std::vector<Eigen::Vector3d>& to, long number) {
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k) {
      const std::string_view word = NextWord(line);
      if (!ReadDouble(word, p[k])) {
        return Bad(number, "got \"" + std::string(word) + "\", want a number");
      }
    }
    to.push_back(p);
    return {};
  }
  Status ReadUv(std::string_view line, long number) {
    double u = 0, v = 0;
    const std::string_view first = NextWord(line), second = NextWord(line);
    if (!ReadDouble(first, u) || (!second.empty() && !ReadDouble(second, v))) {
      return Bad(number, "got \"" + std::string(first) + " " + std::string(second) +
                             "\", want two numbers");
    }
    uvs_.emplace_back(float(u), float(1 - v));  // v runs downwards here
    return {};
  }
  // Index of one of `count` things as written: 1 is the first, -1 the last.
  static bool ReadIndex(std::string_view word, std::size_t count, int& index) {
    long value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value == 0) return false;
    const long at = value > 0 ? value - 1 : long(count) + value;
    if (at < 0 || at >= long(count)) return false;
    index = int(at);
    return true;
  }
  Status ReadFace(std::string_view line, long number) {
    TriangleMesh& mesh = model_.parts.back().mesh;
    std::vector<int> polygon;
    for (std::string_view word = NextWord(line); !word.empty(); word = NextWord(line)) {
      const std::size_t slash = word.find('/'), last = word.rfind('/');
      int point = 0, uv = -1, normal = -1;
      if (!ReadIndex(word.substr(0, slash), points_.size(), point)) {
        return Bad(number, "got corner \"" + std::string(word) + "\", want 1.." +
                               std::to_string(points_.size()));
      }
      if (slash != std::string_view::npos) {
        const std::string_view second =
            word.substr(slash + 1, last == slash ? std::string_view::npos : last - slash - 1);
        if (!second.empty() && !ReadIndex(second, uvs_.size(), uv)) {
          return Bad(number, "got texture point \"" + std::string(word) + "\", want 1.." +
                                 std::to_string(uvs_.size()));
        }
      }
      if (slash != std::string_view::npos && last + 1 < word.size() && last != slash) {
        if (!ReadIndex(word.substr(last + 1), normals_.size(), normal)) {
          return Bad(number, "got normal \"" + std::string(word) + "\", want 1.." +
                                 std::to_string(normals_.size()));
        }
      }
      const auto [at, fresh] =
          corners_.emplace(std::array{point, uv, normal}, int(mesh.positions.size()));
      if (fresh) {
        mesh.positions.push_back(points_[std::size_t(point)]);
        const bool has = normal >= 0 && normals_[std::size_t(normal)].norm() > 0;
        if (has && mesh.normals.size() + 1 == mesh.positions.size()) {
          mesh.normals.push_back(normals_[std::size_t(normal)].normalized());
        }
        if (uv >= 0 && mesh.uvs.size() + 1 == mesh.positions.size()) {
          mesh.uvs.push_back(uvs_[std::size_t(uv)]);
        }
      }
      polygon.push_back(at->second);
    }
    if (polygon.size() < 3) return Bad(number, "got a face of fewer than 3 corners");
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      mesh.triangles.emplace_back(polygon[0], polygon[k], polygon[k + 1]);
    }
    return {};
  }

  std::string name_, folder_;
  std::string object_ = "object", material_;
  std::vector<Eigen::Vector3d> points_, normals_;
  std::vector<Eigen::Vector2f> uvs_;
  std::map<std::array<int, 3>, int> corners_;  // (point, uv, normal) to vertex of the current part
  std::map<std::string, MtlMaterial> materials_;
  ModelFile model_;
};

}  // namespace

Result<ModelFile> ParseObj(std::string_view text, const std::string& name,
                           const std::string& folder) {
  ObjParser parser(name, folder);
  long number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    LG_RETURN_IF_ERROR(parser.Line(text.substr(0, end), ++number));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parser.Finish();
}

}  // namespace lorgnette
