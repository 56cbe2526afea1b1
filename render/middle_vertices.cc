// SPDX-License-Identifier: Apache-2.0
#include "render/middle_vertices.h"

#include <algorithm>

namespace lorgnette {
namespace {

constexpr double kOff = 0.1;  // of the two neighbours' distance
constexpr double kNormalsApart = 0.1;

// The neighbours of every vertex, each once.
class Neighbours {
 public:
  explicit Neighbours(const TriangleMesh& mesh) : first_(mesh.positions.size() + 1, 0) {
    for (const Eigen::Vector3i& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) first_[std::size_t(t[k]) + 1] += 2;
    }
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    list_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const Eigen::Vector3i& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) {
        std::size_t& at = next[std::size_t(t[k])];
        list_[at++] = std::uint32_t(t[(k + 1) % 3]);
        list_[at++] = std::uint32_t(t[(k + 2) % 3]);
      }
    }
    end_.resize(mesh.positions.size());
    for (std::size_t i = 0; i < end_.size(); ++i) {
      const auto begin = list_.begin() + std::ptrdiff_t(first_[i]);
      const auto end = list_.begin() + std::ptrdiff_t(first_[i + 1]);
      std::sort(begin, end);
      end_[i] = std::size_t(std::unique(begin, end) - list_.begin());
    }
  }
  std::size_t first(std::size_t vertex) const { return first_[vertex]; }
  std::size_t end(std::size_t vertex) const { return end_[vertex]; }
  std::uint32_t operator[](std::size_t at) const { return list_[at]; }

 private:
  std::vector<std::size_t> first_, end_;
  std::vector<std::uint32_t> list_;
};

bool IsMiddle(const TriangleMesh& mesh, std::size_t v, std::size_t a, std::size_t b) {
  const Eigen::Vector3d apart = mesh.positions[a] - mesh.positions[b];
  const Eigen::Vector3d off = mesh.positions[v] - 0.5 * (mesh.positions[a] + mesh.positions[b]);
  if (off.squaredNorm() > kOff * kOff * apart.squaredNorm()) return false;
  const Eigen::Vector3d turn = mesh.normals[v] - 0.5 * (mesh.normals[a] + mesh.normals[b]);
  return turn.squaredNorm() <= kNormalsApart * kNormalsApart;
}

}  // namespace

std::vector<MiddleVertex> MiddleVertices(const TriangleMesh& mesh) {
  const Neighbours neighbours(mesh);
  std::vector<bool> is_middle(mesh.positions.size(), false), is_end(mesh.positions.size(), false);
  std::vector<MiddleVertex> found;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (is_end[v]) continue;
    const std::size_t end = neighbours.end(v);
    for (std::size_t i = neighbours.first(v); i < end && !is_middle[v]; ++i) {
      if (is_middle[neighbours[i]]) continue;
      for (std::size_t j = i + 1; j < end; ++j) {
        if (is_middle[neighbours[j]] || !IsMiddle(mesh, v, neighbours[i], neighbours[j])) continue;
        found.push_back({std::uint32_t(v), neighbours[i], neighbours[j]});
        is_middle[v] = is_end[neighbours[i]] = is_end[neighbours[j]] = true;
        break;
      }
    }
  }
  return found;
}

}  // namespace lorgnette
