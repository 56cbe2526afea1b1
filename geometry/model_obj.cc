// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ: v, vn, vt, f (any polygon, negative indices), o, g, usemtl. Materials are named in
// another file that is not read: a name with "lens" or "glass" in it counts as transparent later.
#include <array>
#include <charconv>
#include <map>
#include <sstream>

#include "geometry/model_file.h"

namespace lorgnette {
namespace {

// Splits off the next word; empty at the end of the line.
std::string_view NextWord(std::string_view& line) {
  const std::size_t start = line.find_first_not_of(" \t\r");
  if (start == std::string_view::npos) return line = {};
  line.remove_prefix(start);
  const std::size_t end = std::min(line.find_first_of(" \t\r"), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

bool ReadDouble(std::string_view word, double& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

class ObjParser {
 public:
  explicit ObjParser(const std::string& name) : name_(name) { Begin("object"); }

  Status Line(std::string_view line, long number) {
    const std::string_view key = NextWord(line);
    if (key == "v") return ReadPoint(line, points_, number);
    if (key == "vn") return ReadPoint(line, normals_, number);
    if (key == "f") return ReadFace(line, number);
    if (key == "o" || key == "g") {
      Begin(std::string(NextWord(line)));
    } else if (key == "usemtl") {
      if (!model_.parts.back().mesh.empty()) Begin(model_.parts.back().name);
      model_.parts.back().name += " " + std::string(NextWord(line));
    }
    return {};
  }
  ModelFile Finish() {
    std::erase_if(model_.parts, [](const ModelPart& part) { return part.mesh.empty(); });
    return std::move(model_);
  }

 private:
  void Begin(std::string part) {
    if (model_.parts.empty() || !model_.parts.back().mesh.empty()) model_.parts.emplace_back();
    model_.parts.back().name = std::move(part);
    corners_.clear();
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
      int point = 0, normal = -1;
      if (!ReadIndex(word.substr(0, slash), points_.size(), point)) {
        return Bad(number, "got corner \"" + std::string(word) + "\", want 1.." +
                               std::to_string(points_.size()));
      }
      if (slash != std::string_view::npos && last + 1 < word.size() && last != slash) {
        if (!ReadIndex(word.substr(last + 1), normals_.size(), normal)) {
          return Bad(number, "got normal \"" + std::string(word) + "\", want 1.." +
                                 std::to_string(normals_.size()));
        }
      }
      const auto [at, fresh] =
          corners_.emplace(std::pair(point, normal), int(mesh.positions.size()));
      if (fresh) {
        mesh.positions.push_back(points_[std::size_t(point)]);
        const bool has = normal >= 0 && normals_[std::size_t(normal)].norm() > 0;
        if (has && mesh.normals.size() + 1 == mesh.positions.size()) {
          mesh.normals.push_back(normals_[std::size_t(normal)].normalized());
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

  std::string name_;
  std::vector<Eigen::Vector3d> points_, normals_;
  std::map<std::pair<int, int>, int> corners_;  // (point, normal) to vertex of the current part
  ModelFile model_;
};

}  // namespace

Result<ModelFile> ParseObj(std::string_view text, const std::string& name) {
  ObjParser parser(name);
  long number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    LG_RETURN_IF_ERROR(parser.Line(text.substr(0, end), ++number));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  ModelFile model = parser.Finish();
  for (ModelPart& part : model.parts) {
    if (part.mesh.normals.size() != part.mesh.positions.size()) ComputeVertexNormals(part.mesh);
  }
  return model;
}

}  // namespace lorgnette
