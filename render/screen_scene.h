// SPDX-License-Identifier: Apache-2.0
// The scene as the camera sees it: vertices in the picture, and the triangles that each tile may
// show. Internal to render/.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "base/camera.h"
#include "render/head_scene.h"
#include "render/tile_mask.h"

namespace lorgnette {

// A vertex in the picture.
struct ScreenPoint {
  float x = 0, y = 0;    // pixels; NaN: cannot be projected
  float inverse_z = -1;  // 1/mm; negative: behind the camera
};

struct ScreenScene {
  TileMask mask;
  std::vector<ScreenPoint> points;  // one a vertex of HeadScene::visible
  // Those of HeadScene::visible whose boxes meet tile i are triangles[first[i] .. first[i + 1]), in
  // their order; of solid parts of the frame the ones that face the camera.
  std::vector<std::uint32_t> first, triangles;
  // False: a triangle lies across the camera's plane, or close to it; the lists are of no use.
  bool complete = true;
};

// The mask is conservative: no pixel outside marked tiles changes. What lies across the camera's
// plane marks every tile.
ScreenScene ProjectScene(const HeadScene& head, const Camera& camera,
                         const Eigen::Isometry3d& camera_from_head);

}  // namespace lorgnette
