// SPDX-License-Identifier: Apache-2.0
#include "geometry/silhouette.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "base/units.h"

namespace lorgnette {
namespace {

// A mesh drawn along z into cells, and the empty regions it encloses.
class Silhouette {
 public:
  explicit Silhouette(const TriangleMesh& mesh) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(kInfinity), high = -low;
    for (const Eigen::Vector3d& p : mesh.positions) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    origin_ = low.head<2>() - Eigen::Vector2d::Constant(2 * kCell_mm);
    width_ = int((high.x() - low.x()) / kCell_mm) + 5;
    height_ = int((high.y() - low.y()) / kCell_mm) + 5;
    cells_.assign(std::size_t(width_) * std::size_t(height_), kEmpty);
    for (const Eigen::Vector3i& t : mesh.triangles) Draw(mesh, t);
  }
  std::vector<SilhouetteRegion> Holes() {
    Flood(0, 0);  // outside
    return All(kEmpty);
  }
  std::vector<SilhouetteRegion> Discs() { return All(kDrawn); }

 private:
  static constexpr double kCell_mm = 0.25;
  static constexpr char kEmpty = 0, kDrawn = 1, kVisited = 2;

  std::vector<SilhouetteRegion> All(char kind) {
    std::vector<SilhouetteRegion> regions;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        if (cells_[Index(x, y)] == kind) regions.push_back(Flood(x, y));
      }
    }
    std::sort(regions.begin(), regions.end(),
              [](const SilhouetteRegion& a, const SilhouetteRegion& b) {
                return a.area_mm2 > b.area_mm2;
              });
    return regions;
  }
  std::size_t Index(int x, int y) const {
    return std::size_t(y) * std::size_t(width_) + std::size_t(x);
  }
  // Conservative: every cell that the triangle's samples at a third of a cell touch.
  void Draw(const TriangleMesh& mesh, const Eigen::Vector3i& t) {
    const Eigen::Vector2d a = mesh.positions[std::size_t(t[0])].head<2>();
    const Eigen::Vector2d ab = mesh.positions[std::size_t(t[1])].head<2>() - a;
    const Eigen::Vector2d ac = mesh.positions[std::size_t(t[2])].head<2>() - a;
    const double longest = std::max({ab.norm(), ac.norm(), (ab - ac).norm()});
    const int n = std::max(1, int(std::ceil(3 * longest / kCell_mm)));
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const Eigen::Vector2d p = (a + ab * i / n + ac * j / n - origin_) / kCell_mm;
        cells_[Index(int(p.x()), int(p.y()))] = kDrawn;
      }
    }
  }
  SilhouetteRegion Flood(int x0, int y0) {
    SilhouetteRegion region;
    const char kind = cells_[Index(x0, y0)];
    Eigen::Vector2d sum(0, 0);
    Eigen::Vector2d low(x0, y0), high(x0 + 1, y0 + 1);
    std::queue<std::pair<int, int>> queue;
    queue.push({x0, y0});
    cells_[Index(x0, y0)] = kVisited;
    long count = 0;
    while (!queue.empty()) {
      const auto [x, y] = queue.front();
      queue.pop();
      ++count;
      sum += Eigen::Vector2d(x + 0.5, y + 0.5);
      low = low.cwiseMin(Eigen::Vector2d(x, y));
      high = high.cwiseMax(Eigen::Vector2d(x + 1, y + 1));
      const int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
      for (const auto& step : steps) {
        const int u = x + step[0], v = y + step[1];
        if (u < 0 || v < 0 || u >= width_ || v >= height_ || cells_[Index(u, v)] != kind) continue;
        cells_[Index(u, v)] = kVisited;
        queue.push({u, v});
      }
    }
    region.area_mm2 = double(count) * kCell_mm * kCell_mm;
    region.centre = origin_ + sum / double(count) * kCell_mm;
    region.low = origin_ + low * kCell_mm;
    region.high = origin_ + high * kCell_mm;
    return region;
  }

  Eigen::Vector2d origin_;
  int width_ = 0, height_ = 0;
  std::vector<char> cells_;
};

bool Drawable(const TriangleMesh& mesh) {
  if (mesh.empty()) return false;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kInfinity), high = -low;
  for (const Eigen::Vector3d& p : mesh.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).head<2>().maxCoeff() <= kWidestSilhouette_mm;
}

}  // namespace

std::vector<SilhouetteRegion> SilhouetteHoles(const TriangleMesh& mesh) {
  return Drawable(mesh) ? Silhouette(mesh).Holes() : std::vector<SilhouetteRegion>{};
}

std::vector<SilhouetteRegion> SilhouetteDiscs(const TriangleMesh& mesh) {
  return Drawable(mesh) ? Silhouette(mesh).Discs() : std::vector<SilhouetteRegion>{};
}

}  // namespace lorgnette
