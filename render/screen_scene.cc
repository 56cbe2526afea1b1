// SPDX-License-Identifier: Apache-2.0
#include "render/screen_scene.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lorgnette {
namespace {

constexpr float kNearest_mm = 1;       // points nearer to the camera's plane are not projected
constexpr float kFarthest_px = 65536;  // nor those that land farther off than this
constexpr float kMargin_px = 1.5f;     // around what marks tiles
constexpr std::size_t kVerticesATask = 2048, kTrianglesATask = 4096;

class Projection {
 public:
  Projection(const Camera& camera, const Eigen::Isometry3d& camera_from_head)
      : fx_(float(camera.fx)),
        fy_(float(camera.fy)),
        cx_(float(camera.cx)),
        cy_(float(camera.cy)),
        rotation_(camera_from_head.rotation().cast<float>()),
        translation_(camera_from_head.translation().cast<float>()) {}

  ScreenPoint operator()(const Eigen::Vector3f& head_point) const {
    const Eigen::Vector3f p = rotation_ * head_point + translation_;
    constexpr float kNot = std::numeric_limits<float>::quiet_NaN();
    const float inverse = 1 / p.z();
    if (!(p.z() >= kNearest_mm)) return {kNot, kNot, p.z() < 0 ? -1.0f : inverse};
    const ScreenPoint at{fx_ * p.x() * inverse + cx_, fy_ * p.y() * inverse + cy_, inverse};
    if (!(std::abs(at.x) < kFarthest_px && std::abs(at.y) < kFarthest_px)) {
      return {kNot, kNot, inverse};
    }
    return at;
  }

 private:
  float fx_, fy_, cx_, cy_;
  Eigen::Matrix3f rotation_;
  Eigen::Vector3f translation_;
};

// A box in the picture, in pixels.
struct ScreenBox {
  float x0 = std::numeric_limits<float>::infinity(), y0 = x0, x1 = -x0, y1 = -x0;
  bool whole = true;  // every point of it could be projected
  bool behind = true;
  void Add(const ScreenPoint& p) {
    x0 = std::min(x0, p.x);
    y0 = std::min(y0, p.y);
    x1 = std::max(x1, p.x);
    y1 = std::max(y1, p.y);
    whole = whole && p.x == p.x;
    behind = behind && p.inverse_z < 0;
  }
};

// Tiles of the picture from first to last column and row; none where last is before first.
struct TileRange {
  int c0, r0, c1, r1;
};

TileRange TilesOf(const ScreenBox& box, float margin, const TileMask& mask) {
  const auto tile = [](float v, int low, int high) {
    constexpr float kTilesAPixel = 1.0f / kTileSide;
    // Positive before it is cut to a whole number.
    return int(std::clamp(v * kTilesAPixel + 1, float(low + 1), float(high + 1))) - 1;
  };
  return {tile(box.x0 - margin, 0, mask.columns), tile(box.y0 - margin, 0, mask.rows),
          tile(box.x1 + margin, -1, mask.columns - 1), tile(box.y1 + margin, -1, mask.rows - 1)};
}

TileRange Everywhere(const TileMask& mask) { return {0, 0, mask.columns - 1, mask.rows - 1}; }

template <typename Visit>
void ForTiles(const TileRange& range, const TileMask& mask, Visit&& visit) {
  for (int row = range.r0; row <= range.r1; ++row) {
    for (int column = range.c0; column <= range.c1; ++column) {
      visit(std::size_t(row) * std::size_t(mask.columns) + std::size_t(column));
    }
  }
}

// What one task finds out about its triangles.
struct Share {
  std::vector<std::uint8_t> content;                            // one a tile
  std::vector<std::uint32_t> count;                             // triangles, one a tile
  std::vector<std::pair<std::uint32_t, std::uint32_t>> covers;  // tile, triangle
  bool complete = true;
};

// TileContent of the tiles that a triangle may change.
class Marks {
 public:
  explicit Marks(const HeadScene& head)
      : head_(head),
        everywhere_(head.paper_shadow.has_value() || head.gather_lattice.has_value()) {}
  std::uint8_t Of(std::size_t triangle) const {
    if (triangle >= head_.visible.first_frame) return kTileFrame;
    if (triangle >= head_.visible.first_occluder) return 0;
    const bool shaded =
        everywhere_ || (head_.baked_shadow && head_.baked_shadow->touched(std::uint32_t(triangle)));
    return shaded ? kTileShadow : 0;
  }
  // Of a solid part, and seen from behind: clockwise from outside, with y down.
  bool IsTurnedAway(std::size_t triangle, const std::vector<ScreenPoint>& points) const {
    if (triangle < head_.visible.first_frame) return false;
    const FrameSurface& frame = head_.frame;
    if (!frame.solid[frame.material_of[triangle - head_.visible.first_frame]]) return false;
    const Eigen::Vector3i& t = head_.visible.triangles[triangle];
    const ScreenPoint &a = points[std::size_t(t[0])], &b = points[std::size_t(t[1])],
                      &c = points[std::size_t(t[2])];
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
  }

 private:
  const HeadScene& head_;
  bool everywhere_;
};

Share Cover(const HeadScene& head, const ScreenScene& screen, std::size_t begin, std::size_t end) {
  const TileMask& mask = screen.mask;
  const Marks marks(head);
  Share share;
  share.content.assign(mask.content.size(), 0);
  share.count.assign(mask.content.size(), 0);
  share.covers.reserve(2 * (end - begin));
  for (std::size_t t = begin; t < end; ++t) {
    ScreenBox box;
    for (int k = 0; k < 3; ++k) {
      box.Add(screen.points[std::size_t(head.visible.triangles[t][k])]);
    }
    // The sides toward the camera cover as much.
    if (box.whole && marks.IsTurnedAway(t, screen.points)) continue;
    if (const std::uint8_t bits = marks.Of(t)) {
      ForTiles(box.whole ? TilesOf(box, kMargin_px, mask) : Everywhere(mask), mask,
               [&](std::size_t tile) { share.content[tile] |= bits; });
    }
    if (!box.whole) {
      share.complete = share.complete && box.behind;
      continue;
    }
    ForTiles(TilesOf(box, 0, mask), mask, [&](std::size_t tile) {
      ++share.count[tile];
      share.covers.emplace_back(std::uint32_t(tile), std::uint32_t(t));
    });
  }
  return share;
}

}  // namespace

ScreenScene ProjectScene(const HeadScene& head, const Camera& camera,
                         const Eigen::Isometry3d& camera_from_head) {
  const Projection project(camera, camera_from_head);
  ScreenScene screen;
  TileMask& mask = screen.mask;
  mask.columns = (camera.width + kTileSide - 1) / kTileSide;
  mask.rows = (camera.height + kTileSide - 1) / kTileSide;
  mask.content.assign(std::size_t(mask.columns) * std::size_t(mask.rows), 0);
  for (std::size_t i = 0; i < head.lenses.size(); ++i) {
    const LensSolid& lens = head.lenses[i];
    ScreenBox box;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d p(corner & 1 ? lens.low().x() : lens.high().x(),
                              corner & 2 ? lens.low().y() : lens.high().y(),
                              corner & 4 ? lens.low().z() : lens.high().z());
      box.Add(project((lens.head_from_lens() * p).cast<float>()));
    }
    ForTiles(box.whole ? TilesOf(box, kMargin_px, mask) : Everywhere(mask), mask,
             [&](std::size_t tile) {
               mask.content[tile] |= std::uint8_t(i == 0 ? kTileRightLens : kTileLeftLens);
             });
  }

  const VisibleMesh& mesh = head.visible;
  screen.points.resize(mesh.vertices.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.vertices.size(), kVerticesATask),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        screen.points[i] = project(mesh.vertices[i]);
                      }
                    });
  // The tasks are the same whatever the number of threads, and so is the order in the lists.
  std::vector<Share> shares((mesh.triangles.size() + kTrianglesATask - 1) / kTrianglesATask);
  tbb::parallel_for(std::size_t(0), shares.size(), [&](std::size_t i) {
    shares[i] = Cover(head, screen, i * kTrianglesATask,
                      std::min((i + 1) * kTrianglesATask, mesh.triangles.size()));
  });
  // Each task's counts become the places of its triangles.
  screen.first.reserve(mask.content.size() + 1);
  std::uint32_t next = 0;
  for (std::size_t tile = 0; tile < mask.content.size(); ++tile) {
    screen.first.push_back(next);
    for (Share& share : shares) {
      mask.content[tile] |= share.content[tile];
      next += std::exchange(share.count[tile], next);
    }
  }
  screen.first.push_back(next);
  screen.triangles.resize(next);
  tbb::parallel_for(std::size_t(0), shares.size(), [&](std::size_t i) {
    for (const auto& [tile, triangle] : shares[i].covers) {
      screen.triangles[shares[i].count[tile]++] = triangle;
    }
  });
  for (const Share& share : shares) screen.complete = screen.complete && share.complete;
  return screen;
}

}  // namespace lorgnette
