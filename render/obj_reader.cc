// SPDX-License-Identifier: Apache-2.0
#include "render/obj_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "base/atomic_file.h"

namespace lorgnette {
namespace {

std::string_view NextWord(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return line = {};
  const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

}  // namespace

Result<TriangleMesh> ReadObjTriangles(const std::string& path) {
  LG_ASSIGN(const std::string text, ReadFile(path));
  TriangleMesh mesh;
  std::string_view rest = text;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::string_view kind = NextWord(line);
    if (kind == "v") {
      Eigen::Vector3d p;
      for (int k = 0; k < 3; ++k) {
        const std::string word(NextWord(line));
        char* stop = nullptr;
        p[k] = std::strtod(word.c_str(), &stop);
        if (word.empty() || *stop != '\0' || !std::isfinite(p[k])) {
          return Failure(
              fmt::format("{}:line {}: got `{}`, want a coordinate", path, number, word));
        }
      }
      mesh.positions.push_back(p);
    } else if (kind == "f") {
      std::vector<int> corners;
      for (std::string_view word = NextWord(line); !word.empty(); word = NextWord(line)) {
        const long n = long(mesh.positions.size());
        const long given = std::strtol(std::string(word).c_str(), nullptr, 10);
        const long index = given < 0 ? n + given : given - 1;
        if (given == 0 || index < 0 || index >= n) {
          return Failure(
              fmt::format("{}:line {}: got vertex `{}`, want 1..{}", path, number, word, n));
        }
        corners.push_back(int(index));
      }
      for (std::size_t k = 2; k < corners.size(); ++k) {
        mesh.triangles.emplace_back(corners[0], corners[k - 1], corners[k]);
      }
    }
  }
  if (mesh.empty()) return Failure(fmt::format("{}: no triangles", path));
  return mesh;
}

}  // namespace lorgnette
