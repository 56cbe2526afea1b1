// SPDX-License-Identifier: Apache-2.0
// What the camera rays of a tile's samples meet, by rasterisation: the nearest triangle of all that
// may cover the tile. Internal to render/.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "render/camera_sample.h"
#include "render/embree_scene.h"
#include "render/head_scene.h"
#include "render/screen_scene.h"

namespace lorgnette {

// Memory is kept from tile to tile.
class TileRaster {
 public:
  // One hit a sample. Both sides of a triangle are met; a position on the common side of two
  // triangles meets one of them at least. Of triangles equally near, the first counts.
  //   samples  of one tile, whose triangles are `tile`'s of a complete `screen`
  // hits[i].distance is measured along the camera's axis, in mm.
  void Trace(const VisibleMesh& mesh, const ScreenScene& screen, std::size_t tile,
             const std::vector<CameraSample>& samples, std::vector<SceneHit>& hits);

 private:
  // Packets of 16 samples, the last one filled up; boxes of packets, filled up to 16 with boxes
  // that hold nothing.
  std::vector<float> x_, y_, u_, v_, low_x_, low_y_, high_x_, high_y_;
  std::vector<float> inverse_z_;
  std::vector<std::uint32_t> nearest_;
};

}  // namespace lorgnette
