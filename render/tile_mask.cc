// SPDX-License-Identifier: Apache-2.0
#include "render/tile_mask.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace lorgnette {
namespace {

constexpr float kNearest_mm = 1;  // points nearer to the camera's plane are not projected
constexpr float kMargin_px = 1.5f;

class Marker {
 public:
  Marker(const Camera& camera, const Eigen::Isometry3d& camera_from_head)
      : camera_(camera),
        rotation_(camera_from_head.rotation().cast<float>()),
        translation_(camera_from_head.translation().cast<float>()) {
    mask.columns = (camera.width + kTileSide - 1) / kTileSide;
    mask.rows = (camera.height + kTileSide - 1) / kTileSide;
    mask.content.assign(std::size_t(mask.columns) * std::size_t(mask.rows), 0);
  }

  // A point in the picture; NaN where it cannot be projected.
  Eigen::Vector2f Project(const Eigen::Vector3f& head_point) const {
    const Eigen::Vector3f p = rotation_ * head_point + translation_;
    if (p.z() < kNearest_mm) return Eigen::Vector2f::Constant(std::nanf(""));
    return {float(camera_.fx) * p.x() / p.z() + float(camera_.cx),
            float(camera_.fy) * p.y() / p.z() + float(camera_.cy)};
  }
  // The tiles, from first to last, that a point with its margin reaches; one beyond the picture's
  // stands for all that lie beyond.
  struct Reach {
    int c0 = 1 << 20, r0 = 1 << 20, c1 = -1, r1 = -1;
    void Add(const Reach& other) {
      c0 = std::min(c0, other.c0);
      r0 = std::min(r0, other.r0);
      c1 = std::max(c1, other.c1);
      r1 = std::max(r1, other.r1);
    }
  };
  Reach ReachOf(const Eigen::Vector3f& head_point) const {
    const Eigen::Vector2f p = Project(head_point);
    if (std::isnan(p.x())) return {0, 0, mask.columns - 1, mask.rows - 1};
    const auto tile = [](float v, int count) {
      return int(std::clamp(std::floor(v / kTileSide), -1.0f, float(count)));
    };
    return {tile(p.x() - kMargin_px, mask.columns), tile(p.y() - kMargin_px, mask.rows),
            tile(p.x() + kMargin_px, mask.columns), tile(p.y() + kMargin_px, mask.rows)};
  }
  template <typename Points>
  std::vector<Reach> ReachOfAll(const Points& points) const {
    std::vector<Reach> reach(points.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 1024),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i < range.end(); ++i) {
                          reach[i] = ReachOf(points[i].template cast<float>());
                        }
                      });
    return reach;
  }
  void Mark(const Reach& reach, std::uint8_t bits, std::vector<std::uint8_t>& content) const {
    for (int row = std::max(reach.r0, 0); row <= std::min(reach.r1, mask.rows - 1); ++row) {
      for (int column = std::max(reach.c0, 0); column <= std::min(reach.c1, mask.columns - 1);
           ++column) {
        content[std::size_t(row) * std::size_t(mask.columns) + std::size_t(column)] |= bits;
      }
    }
  }

  // What lies between the corners of those triangles of which `takes` is true.
  template <typename Takes>
  void MarkTriangles(const std::vector<Eigen::Vector3i>& triangles, const std::vector<Reach>& reach,
                     std::uint8_t bits, Takes&& takes) {
    std::mutex mutex;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, triangles.size(), 8192),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        std::vector<std::uint8_t> content(mask.content.size(), 0);
                        for (std::size_t t = range.begin(); t < range.end(); ++t) {
                          if (!takes(t)) continue;
                          Reach all;
                          for (int k = 0; k < 3; ++k) {
                            all.Add(reach[std::size_t(triangles[t][k])]);
                          }
                          Mark(all, bits, content);
                        }
                        const std::lock_guard<std::mutex> lock(mutex);
                        for (std::size_t i = 0; i < content.size(); ++i) {
                          mask.content[i] |= content[i];
                        }
                      });
  }

  TileMask mask;

 private:
  Camera camera_;
  Eigen::Matrix3f rotation_;
  Eigen::Vector3f translation_;
};

}  // namespace

PixelBox TileMask::Area(std::size_t tile, int width, int height) const {
  const int x0 = int(tile) % columns * kTileSide, y0 = int(tile) / columns * kTileSide;
  return {x0, y0, std::min(x0 + kTileSide, width), std::min(y0 + kTileSide, height)};
}

PixelBox TileMask::Bounds() const {
  PixelBox box{columns * kTileSide, rows * kTileSide, 0, 0};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (content[std::size_t(row) * std::size_t(columns) + std::size_t(column)] == 0) continue;
      box = {std::min(box.x0, column * kTileSide), std::min(box.y0, row * kTileSide),
             std::max(box.x1, (column + 1) * kTileSide), std::max(box.y1, (row + 1) * kTileSide)};
    }
  }
  return box.empty() ? PixelBox{} : box;
}

TileMask MarkTiles(const HeadScene& head, const Camera& camera,
                   const Eigen::Isometry3d& camera_from_head) {
  Marker marker(camera, camera_from_head);
  marker.MarkTriangles(head.frame.mesh.triangles, marker.ReachOfAll(head.frame.mesh.positions),
                       kTileFrame, [](std::size_t) { return true; });
  for (std::size_t i = 0; i < head.lenses.size(); ++i) {
    const LensSolid& lens = head.lenses[i];
    Marker::Reach reach;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d p(corner & 1 ? lens.low().x() : lens.high().x(),
                              corner & 2 ? lens.low().y() : lens.high().y(),
                              corner & 4 ? lens.low().z() : lens.high().z());
      reach.Add(marker.ReachOf((lens.head_from_lens() * p).cast<float>()));
    }
    marker.Mark(reach, i == 0 ? kTileRightLens : kTileLeftLens, marker.mask.content);
  }
  const bool everywhere = head.paper_shadow.has_value() || head.gather_lattice.has_value();
  if (!everywhere && !head.baked_shadow) return std::move(marker.mask);
  marker.MarkTriangles(
      head.face_triangles, marker.ReachOfAll(head.face_vertices), kTileShadow,
      [&](std::size_t t) { return everywhere || head.baked_shadow->touched(std::uint32_t(t)); });
  return std::move(marker.mask);
}

}  // namespace lorgnette
