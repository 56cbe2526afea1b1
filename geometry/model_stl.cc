// SPDX-License-Identifier: Apache-2.0
// STL, ASCII and binary. Facets' own normals are not kept: they are those of the triangles.
#include <charconv>
#include <cstring>

#include "geometry/mesh_check.h"
#include "geometry/model_file.h"

namespace lorgnette {
namespace {

constexpr std::size_t kHeader = 84, kFacet = 50;

Result<ModelFile> FromCorners(std::vector<Eigen::Vector3d> corners, const std::string& name) {
  for (const Eigen::Vector3d& p : corners) {
    if (!p.allFinite()) return Failure(name + ": got a vertex that is not finite");
  }
  TriangleMesh soup;
  soup.positions = std::move(corners);
  for (int k = 0; k + 2 < int(soup.positions.size()); k += 3) {
    soup.triangles.emplace_back(k, k + 1, k + 2);
  }
  ModelFile model;
  model.parts.emplace_back();
  model.parts[0].name = "solid";
  model.parts[0].mesh = MergeEqualPositions(soup);
  ComputeVertexNormals(model.parts[0].mesh);
  return model;
}

Result<ModelFile> ParseBinary(std::string_view bytes, std::size_t count, const std::string& name) {
  std::vector<Eigen::Vector3d> corners;
  corners.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    float numbers[12];
    std::memcpy(numbers, bytes.data() + kHeader + i * kFacet, sizeof numbers);
    for (int k = 1; k < 4; ++k) {
      corners.emplace_back(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]);
    }
  }
  return FromCorners(std::move(corners), name);
}

Result<ModelFile> ParseText(std::string_view text, const std::string& name) {
  std::vector<Eigen::Vector3d> corners;
  for (std::size_t at = text.find("vertex"); at != std::string_view::npos;
       at = text.find("vertex", at)) {
    at += 6;
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k) {
      at = std::min(text.find_first_not_of(" \t", at), text.size());
      if (at < text.size() && text[at] == '+') ++at;
      const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), p[k]);
      if (error != std::errc()) {
        return Failure(name + ": got a vertex that is no three numbers, the " +
                       std::to_string(corners.size() + 1) + "th");
      }
      at = std::size_t(end - text.data());
    }
    corners.push_back(p);
  }
  if (corners.empty() || corners.size() % 3 != 0) {
    return Failure(name + ": got " + std::to_string(corners.size()) +
                   " vertices, want three a facet");
  }
  return FromCorners(std::move(corners), name);
}

}  // namespace

Result<ModelFile> ParseStl(std::string_view bytes, const std::string& name) {
  // Binary when its length is what its count says; some writers begin binary files with "solid".
  if (bytes.size() >= kHeader) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    if (bytes.size() == kHeader + kFacet * std::size_t(count))
      return ParseBinary(bytes, count, name);
  }
  if (bytes.substr(0, 5) != "solid") {
    return Failure(name + ": got neither ASCII STL nor a binary one of the length it states");
  }
  return ParseText(bytes, name);
}

}  // namespace lorgnette
