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
  struct Box {
    float x0 = 1e30f, y0 = 1e30f, x1 = -1e30f, y1 = -1e30f;
    bool everywhere = false;
    void Add(const Eigen::Vector2f& p) {
      if (std::isnan(p.x())) {
        everywhere = true;
        return;
      }
      x0 = std::min(x0, p.x());
      x1 = std::max(x1, p.x());
      y0 = std::min(y0, p.y());
      y1 = std::max(y1, p.y());
    }
  };
  template <typename Points>
  std::vector<Eigen::Vector2f> ProjectAll(const Points& points) const {
    std::vector<Eigen::Vector2f> projected(points.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 1024),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i < range.end(); ++i) {
                          projected[i] = Project(points[i].template cast<float>());
                        }
                      });
    return projected;
  }
  void Mark(const Box& box, std::uint8_t bits, std::vector<std::uint8_t>& content) const {
    int c0 = 0, r0 = 0, c1 = mask.columns - 1, r1 = mask.rows - 1;
    if (!box.everywhere) {
      if (box.x1 + kMargin_px < 0 || box.y1 + kMargin_px < 0 ||
          box.x0 - kMargin_px > float(camera_.width) ||
          box.y0 - kMargin_px > float(camera_.height)) {
        return;
      }
      const auto tile = [](float v, int last) {
        return std::clamp(int(std::floor(v / kTileSide)), 0, last);
      };
      c0 = tile(box.x0 - kMargin_px, c1);
      c1 = tile(box.x1 + kMargin_px, c1);
      r0 = tile(box.y0 - kMargin_px, r1);
      r1 = tile(box.y1 + kMargin_px, r1);
    }
    for (int row = r0; row <= r1; ++row) {
      for (int column = c0; column <= c1; ++column) {
        content[std::size_t(row) * std::size_t(mask.columns) + std::size_t(column)] |= bits;
      }
    }
  }

  // The boxes of those triangles of which `takes` is true, by the projections of their vertices.
  template <typename Takes>
  void MarkTriangles(const std::vector<Eigen::Vector3i>& triangles,
                     const std::vector<Eigen::Vector2f>& projected, std::uint8_t bits,
                     Takes&& takes) {
    std::mutex mutex;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, triangles.size(), 8192),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        std::vector<std::uint8_t> content(mask.content.size(), 0);
                        for (std::size_t t = range.begin(); t < range.end(); ++t) {
                          if (!takes(t)) continue;
                          Box box;
                          for (int k = 0; k < 3; ++k) {
                            box.Add(projected[std::size_t(triangles[t][k])]);
                          }
                          Mark(box, bits, content);
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
  const std::vector<Eigen::Vector2f> frame = marker.ProjectAll(head.frame.mesh.positions);
  marker.MarkTriangles(head.frame.mesh.triangles, frame, kTileFrame,
                       [](std::size_t) { return true; });
  for (std::size_t i = 0; i < head.lenses.size(); ++i) {
    const LensSolid& lens = head.lenses[i];
    Marker::Box box;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d p(corner & 1 ? lens.low().x() : lens.high().x(),
                              corner & 2 ? lens.low().y() : lens.high().y(),
                              corner & 4 ? lens.low().z() : lens.high().z());
      box.Add(marker.Project((lens.head_from_lens() * p).cast<float>()));
    }
    marker.Mark(box, i == 0 ? kTileRightLens : kTileLeftLens, marker.mask.content);
  }
  const bool everywhere = head.paper_shadow.has_value() || head.gather_lattice.has_value();
  if (!everywhere && !head.baked_shadow) return std::move(marker.mask);
  const std::vector<Eigen::Vector2f> face = marker.ProjectAll(head.face_vertices);
  marker.MarkTriangles(head.face_triangles, face, kTileShadow, [&](std::size_t t) {
    return everywhere || head.baked_shadow->touched(std::uint32_t(t));
  });
  return std::move(marker.mask);
}

}  // namespace lorgnette
