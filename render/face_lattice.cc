// SPDX-License-Identifier: Apache-2.0
#include "render/face_lattice.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace lorgnette {
namespace {

constexpr double kNear_mm = 6;  // contact shadows are sharper than the far lattice up to here
constexpr int kMaxCells = 24;   // along a triangle's side

// Cubes of side kNear_mm that hold a vertex of the frame, or neighbour one that does.
class NearFrame {
 public:
  explicit NearFrame(const TriangleMesh& frame) {
    for (const Eigen::Vector3d& p : frame.positions) {
      const Eigen::Vector3i c = Cell(p);
      for (int dz = -1; dz <= 1; ++dz) {
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) cells_.insert(Key(c + Eigen::Vector3i(dx, dy, dz)));
        }
      }
    }
  }
  bool Contains(const Eigen::Vector3d& p) const { return cells_.contains(Key(Cell(p))); }

 private:
  static Eigen::Vector3i Cell(const Eigen::Vector3d& p) {
    return (p / kNear_mm).array().floor().cast<int>();
  }
  static std::int64_t Key(const Eigen::Vector3i& c) {
    constexpr std::int64_t kBias = 1 << 20;
    return ((c.x() + kBias) << 42) | ((c.y() + kBias) << 21) | (c.z() + kBias);
  }
  std::unordered_set<std::int64_t> cells_;
};

LatticePoint PointOf(const TriangleMesh& face, std::uint32_t index, float u, float v) {
  LatticePoint point{index, u, v, Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
  const Eigen::Vector3i& triangle = face.triangles[index];
  const float w[3] = {1 - u - v, u, v};
  for (int k = 0; k < 3; ++k) {
    point.position += w[k] * face.positions[std::size_t(triangle[k])].cast<float>();
    point.normal += w[k] * face.normals[std::size_t(triangle[k])].cast<float>();
  }
  point.normal.normalize();
  return point;
}

}  // namespace

FaceLattice::FaceLattice(const TriangleMesh& face, const TriangleMesh& frame, double near_mm,
                         double far_mm) {
  const NearFrame near_frame(frame);
  constexpr std::uint32_t kUnset = ~0u;
  std::vector<std::uint32_t> vertex_point(face.positions.size(), kUnset);
  for (std::size_t t = 0; t < face.triangles.size(); ++t) {
    const Eigen::Vector3i& triangle = face.triangles[t];
    const Eigen::Vector3d corners[3] = {face.positions[std::size_t(triangle[0])],
                                        face.positions[std::size_t(triangle[1])],
                                        face.positions[std::size_t(triangle[2])]};
    const double side =
        std::max({(corners[0] - corners[1]).norm(), (corners[1] - corners[2]).norm(),
                  (corners[2] - corners[0]).norm()});
    const bool near = near_frame.Contains((corners[0] + corners[1] + corners[2]) / 3) ||
                      near_frame.Contains(corners[0]) || near_frame.Contains(corners[1]) ||
                      near_frame.Contains(corners[2]);
    const double spacing = near ? near_mm : far_mm;
    const int cells = std::clamp(int(std::ceil(side / spacing)), 1, kMaxCells);
    lattices_.push_back({std::uint32_t(corners_.size()), std::uint16_t(cells), false});
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i + j <= cells; ++i) {
        const int corner = i == cells ? 1 : j == cells ? 2 : i + j == 0 ? 0 : -1;
        std::uint32_t* shared = corner < 0 ? nullptr : &vertex_point[std::size_t(triangle[corner])];
        if (shared != nullptr && *shared != kUnset) {
          corners_.push_back(*shared);
          continue;
        }
        if (shared != nullptr) *shared = std::uint32_t(points_.size());
        corners_.push_back(std::uint32_t(points_.size()));
        points_.push_back(
            PointOf(face, std::uint32_t(t), float(i) / float(cells), float(j) / float(cells)));
      }
    }
  }
}

void FaceLattice::Touch(const std::vector<bool>& marked) {
  for (Lattice& lattice : lattices_) {
    const std::uint32_t n = (lattice.cells + 1u) * (lattice.cells + 2u) / 2;
    for (std::uint32_t k = 0; k < n; ++k) {
      lattice.touched = lattice.touched || marked[corners_[lattice.first + k]];
    }
  }
}

Eigen::Vector3f FaceLattice::Interpolate(const std::vector<Eigen::Vector3f>& values,
                                         std::uint32_t triangle, float u, float v) const {
  const Lattice& lattice = lattices_[triangle];
  if (!lattice.touched) return Eigen::Vector3f::Ones();
  const int cells = lattice.cells;
  const float x = std::clamp(u, 0.0f, 1.0f) * float(cells);
  const float y = std::clamp(v, 0.0f, 1.0f) * float(cells);
  const int j = std::min(int(y), cells - 1);
  const int i = std::min(int(x), cells - 1 - j);
  const float fx = std::clamp(x - float(i), 0.0f, 1.0f), fy = std::clamp(y - float(j), 0.0f, 1.0f);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weight = 0;
  const auto add = [&](float w, int column, int row) {
    const int index = row * (cells + 1) - row * (row - 1) / 2 + column;
    const Eigen::Vector3f& value = values[corners_[lattice.first + std::size_t(index)]];
    if (value.x() == kNoValue) return;
    sum += w * value;
    weight += w;
  };
  if (fx + fy <= 1 || i + j + 2 > cells) {
    add(std::max(1 - fx - fy, 0.0f), i, j);
    add(fx, i + 1, j);
    add(fy, i, j + 1);
  } else {
    add(fx + fy - 1, i + 1, j + 1);
    add(1 - fx, i, j + 1);
    add(1 - fy, i + 1, j);
  }
  constexpr float kLeastWeight = 1e-3f;
  return weight > kLeastWeight ? Eigen::Vector3f(sum / weight) : Eigen::Vector3f::Ones();
}

}  // namespace lorgnette
