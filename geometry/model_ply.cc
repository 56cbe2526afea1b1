// SPDX-License-Identifier: Apache-2.0
// PLY, ASCII and binary (either byte order): elements vertex (x, y, z) and face (a list of
// vertices); other elements and properties are read over.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>

#include "geometry/model_file.h"

namespace lorgnette {
namespace {

enum class Encoding { kText, kLittle, kBig };

struct Type {
  int size = 0;
  char kind = 'i';  // i signed, u unsigned, f floating
};
const std::map<std::string, Type, std::less<>> kTypes = {
    {"char", {1, 'i'}},  {"int8", {1, 'i'}},    {"uchar", {1, 'u'}},  {"uint8", {1, 'u'}},
    {"short", {2, 'i'}}, {"int16", {2, 'i'}},   {"ushort", {2, 'u'}}, {"uint16", {2, 'u'}},
    {"int", {4, 'i'}},   {"int32", {4, 'i'}},   {"uint", {4, 'u'}},   {"uint32", {4, 'u'}},
    {"float", {4, 'f'}}, {"float32", {4, 'f'}}, {"double", {8, 'f'}}, {"float64", {8, 'f'}}};

struct Property {
  std::string name;
  bool list = false;
  Type count, type;
};
struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

class PlyParser {
 public:
  PlyParser(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

  Result<ModelFile> Parse() {
    LG_RETURN_IF_ERROR(ReadHeader());
    TriangleMesh mesh;
    for (const Element& element : elements_) {
      for (std::size_t i = 0; i < element.count; ++i) {
        LG_RETURN_IF_ERROR(ReadRow(element, mesh));
      }
    }
    ModelFile model;
    model.parts.emplace_back();
    model.parts[0].name = "mesh";
    for (const Eigen::Vector3i& t : mesh.triangles) {
      if (t.minCoeff() < 0 || t.maxCoeff() >= int(mesh.positions.size())) {
        return Failure(name_ + ": got a face with a corner out of range");
      }
    }
    ComputeVertexNormals(mesh);
    model.parts[0].mesh = std::move(mesh);
    return model;
  }

 private:
  std::string_view Line() {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }
  static std::vector<std::string> Words(std::string_view line) {
    std::vector<std::string> words;
    for (std::size_t at = line.find_first_not_of(' '); at != std::string_view::npos;
         at = line.find_first_not_of(' ', at)) {
      const std::size_t end = std::min(line.find(' ', at), line.size());
      words.emplace_back(line.substr(at, end - at));
      at = end;
    }
    return words;
  }

  Status ReadHeader() {
    if (Line() != "ply") return Failure(name_ + ": got no \"ply\" in the first line");
    while (!rest_.empty()) {
      const std::vector<std::string> words = Words(Line());
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") return {};
      LG_RETURN_IF_ERROR(ReadHeaderLine(words));
    }
    return Failure(name_ + ": got no end_header");
  }
  Status ReadHeaderLine(const std::vector<std::string>& words) {
    const auto type = [&](const std::string& word, Type& to) {
      const auto at = kTypes.find(word);
      if (at != kTypes.end()) to = at->second;
      return at != kTypes.end();
    };
    if (words[0] == "format" && words.size() >= 2) {
      encoding_ = words[1] == "ascii"                  ? Encoding::kText
                  : words[1] == "binary_little_endian" ? Encoding::kLittle
                                                       : Encoding::kBig;
      return {};
    }
    if (words[0] == "element" && words.size() == 3) {
      Element element;
      element.name = words[1];
      const auto [end, error] =
          std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
      // Each row takes at least a byte: more rows than bytes cannot be meant.
      if (error != std::errc() || element.count > rest_.size()) {
        return Failure(name_ + ":" + words[1] + ": got a count of " + words[2] +
                       ", more than the file can hold");
      }
      elements_.push_back(std::move(element));
      return {};
    }
    if (words[0] == "property" && !elements_.empty()) {
      Property property;
      property.name = words.back();
      property.list = words.size() == 5 && words[1] == "list";
      const bool known = property.list
                             ? type(words[2], property.count) && type(words[3], property.type)
                             : words.size() == 3 && type(words[1], property.type);
      if (!known) return Failure(name_ + ":" + words.back() + ": got an unknown type of property");
      elements_.back().properties.push_back(std::move(property));
      return {};
    }
    return Failure(name_ + ": got the header line \"" + words[0] + "\"");
  }

  bool ReadValue(Type type, double& value) {
    if (encoding_ == Encoding::kText) {
      const std::size_t start = rest_.find_first_not_of(" \t\r\n");
      if (start == std::string_view::npos) return false;
      rest_.remove_prefix(start);
      const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
      if (error != std::errc()) return false;
      rest_.remove_prefix(std::size_t(end - rest_.data()));
      return true;
    }
    const std::size_t size = std::size_t(type.size);
    if (rest_.size() < size) return false;
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < size; ++k) {
      const std::size_t from = encoding_ == Encoding::kLittle ? size - 1 - k : k;
      bits = (bits << 8) | std::uint8_t(rest_[from]);
    }
    rest_.remove_prefix(size);
    if (type.kind == 'f') {
      value = size == 4 ? double(std::bit_cast<float>(std::uint32_t(bits)))
                        : std::bit_cast<double>(bits);
    } else if (type.kind == 'i' && size < 8 && (bits >> (8 * size - 1)) != 0) {
      value = double(std::int64_t(bits | (~std::uint64_t(0) << (8 * size))));
    } else {
      value = double(bits);
    }
    return true;
  }

  Status ReadRow(const Element& element, TriangleMesh& mesh) {
    Eigen::Vector3d point(0, 0, 0);
    for (const Property& property : element.properties) {
      double value = 0;
      if (!ReadValue(property.list ? property.count : property.type, value)) return Short();
      if (!property.list) {
        if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z') {
          point[property.name[0] - 'x'] = value;
        }
        continue;
      }
      if (!(value >= 0 && value <= double(rest_.size()))) return Short();
      std::vector<int> polygon;
      for (std::size_t k = 0; k < std::size_t(value); ++k) {
        double corner = 0;
        if (!ReadValue(property.type, corner)) return Short();
        polygon.push_back(std::abs(corner) < 2e9 ? int(corner) : -1);
      }
      if (element.name != "face") continue;
      for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
        mesh.triangles.emplace_back(polygon[0], polygon[k], polygon[k + 1]);
      }
    }
    if (!point.allFinite()) return Failure(name_ + ": got a vertex that is not finite");
    if (element.name == "vertex") mesh.positions.push_back(point);
    return {};
  }
  tl::unexpected<Error> Short() const {
    return Failure(name_ + ": got too few numbers, the file ends early or a number is broken");
  }

  std::string_view rest_;
  std::string name_;
  Encoding encoding_ = Encoding::kText;
  std::vector<Element> elements_;
};

}  // namespace

Result<ModelFile> ParsePly(std::string_view bytes, const std::string& name) {
  return PlyParser(bytes, name).Parse();
}

}  // namespace lorgnette
