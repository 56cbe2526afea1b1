// SPDX-License-Identifier: Apache-2.0
#include "render/face_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_set>
#include <utility>

namespace lorgnette {
namespace {

constexpr double kNear_mm = 6;  // contact shadows are sharper than the far lattice up to here
constexpr int kMaxCells = 24;   // along a triangle's side

// Cubes of side kNear_mm that hold a vertex of the frame, or neighbour one that does.
class NearFrame {
 public:
  explicit NearFrame(const TriangleMesh& frame) {
    std::unordered_set<std::int64_t> seen;
    for (const Eigen::Vector3d& p : frame.positions) {
      const Eigen::Vector3i c = Cell(p);
      if (!seen.insert(Key(c)).second) continue;
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

// Cells along a side, of numbers that halve evenly, so that points lie between others and
// neighbouring triangles share those of their edges.
int CellsNear(double wanted) { return std::clamp(4 * int(std::ceil(wanted / 4)), 4, kMaxCells); }
int CellsFar(double wanted) {
  return std::min(1 << int(std::ceil(std::log2(std::max(wanted, 1.0)))), kMaxCells);
}

// Of a point in a triangle's list: row by row, each row one shorter than the last.
int IndexInLattice(int cells, int column, int row) {
  return row * (cells + 1) - row * (row - 1) / 2 + column;
}

// Points on vertices and edges, which several triangles have.
class SharedPoints {
 public:
  // The index of the point (i, j) of a triangle of so many cells: `next` where it is a new one.
  std::uint32_t Index(const Eigen::Vector3i& triangle, int cells, int i, int j, std::uint32_t next,
                      bool& is_new) {
    // Corner (0, 0) is the triangle's first vertex, (cells, 0) its second, (0, cells) its third.
    int from = 0, to = 0, step = 0;
    if (i + j == cells) {
      from = 1, to = 2, step = j;
    } else if (j == 0) {
      from = 0, to = 1, step = i;
    } else if (i == 0) {
      from = 0, to = 2, step = j;
    } else {
      return next;
    }
    if (step == cells) std::swap(from, to), step = 0;
    Key key{triangle[from], triangle[to], cells, step};
    if (step == 0) {
      key = {triangle[from], triangle[from], 0, 0};
    } else if (triangle[from] > triangle[to]) {
      key = {triangle[to], triangle[from], cells, cells - step};
    }
    const auto [found, added] = points_.try_emplace(key, next);
    is_new = added;
    return found->second;
  }

 private:
  using Key = std::array<int, 4>;  // vertices of the edge, cells, steps from the first
  std::map<Key, std::uint32_t> points_;
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
  SharedPoints shared;
  std::vector<int> level_of;  // of the points: 0 where they are between no two others
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
    const int cells = near ? CellsNear(side / near_mm) : CellsFar(side / far_mm);
    lattices_.push_back({std::uint32_t(corners_.size()), std::uint16_t(cells), false});
    corners_.resize(corners_.size() + std::size_t((cells + 1) * (cells + 2) / 2));
    const auto corner = [&](int i, int j) -> std::uint32_t& {
      return corners_[lattices_.back().first + std::size_t(IndexInLattice(cells, i, j))];
    };
    // First every fourth point each way, then every second, then all.
    for (int level = 0; level <= kLevels; ++level) {
      const int step = 1 << (kLevels - level);
      for (int j = 0; j <= cells; j += step) {
        for (int i = 0; i + j <= cells; i += step) {
          if (level > 0 && (i | j) % (2 * step) == 0) continue;
          bool is_new = true;
          corner(i, j) = shared.Index(triangle, cells, i, j, std::uint32_t(points_.size()), is_new);
          if (!is_new) continue;
          points_.push_back(
              PointOf(face, std::uint32_t(t), float(i) / float(cells), float(j) / float(cells)));
          level_of.push_back(0);
          if (level == 0) continue;
          // Along the side of the triangle of coarser points on whose middle this one lies.
          const bool odd_i = i % (2 * step) != 0, odd_j = j % (2 * step) != 0;
          const int di = odd_i ? step : 0, dj = odd_j ? (odd_i ? -step : step) : 0;
          if (i + di + j + dj > cells || i - di + j - dj > cells) continue;
          const std::uint32_t one = corner(i + di, j + dj), other = corner(i - di, j - dj);
          if (level_of[one] >= level || level_of[other] >= level) continue;
          level_of.back() = level;
          between_[std::size_t(level - 1)].push_back({corner(i, j), one, other});
        }
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
    const auto index = std::size_t(IndexInLattice(cells, column, row));
    const Eigen::Vector3f& value = values[corners_[lattice.first + index]];
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
