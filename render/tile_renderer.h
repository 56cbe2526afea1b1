// SPDX-License-Identifier: Apache-2.0
// Samples of a tile, in batches: primary rays and what leaves the glass in packets of 16, lenses by
// the SIMD kernel; what meets a lens's edge goes the exact way of RayFollower. Internal to render/.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "render/camera_sample.h"
#include "render/ray_follower.h"
#include "render/tile_mask.h"

namespace lorgnette {

struct TileBatch;

class TileRenderer {
 public:
  TileRenderer(const HeadScene& head, const RayFollower& follower, const Camera& camera,
               const Eigen::Isometry3d& camera_from_head);

  // Traces the samples. Neighbours in the list should be neighbours in the picture.
  //   content  TileContent bits of the tile that holds them all
  void Trace(std::vector<CameraSample>& samples, std::uint8_t content,
             std::vector<PixelState>& pixels) const;

 private:
  void TracePrimary(RaySet set, TileBatch& batch, std::vector<CameraSample>& samples) const;
  void TraceGloss(TileBatch& batch, const std::vector<CameraSample>& samples,
                  std::vector<PixelState>& pixels) const;
  void TraceExactly(std::size_t sample, const TileBatch& batch, std::vector<CameraSample>& samples,
                    std::vector<PixelState>& pixels) const;
  void Direct(std::size_t sample, const TileBatch& batch, std::vector<CameraSample>& samples,
              std::vector<PixelState>& pixels) const;

  const HeadScene& head_;
  const RayFollower& follower_;
  Camera camera_;
  Eigen::Matrix3f head_from_camera_;
  Eigen::Vector3d eye_;
};

}  // namespace lorgnette
