// SPDX-License-Identifier: Apache-2.0
// Samples of a tile, in batches: camera rays by rasterisation, lenses by the SIMD kernel, what
// leaves the glass in packets of 16; what meets a lens's edge goes the exact way of RayFollower.
// Internal to render/.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "render/camera_sample.h"
#include "render/ray_follower.h"
#include "render/screen_scene.h"

namespace lorgnette {

struct TileBatch;

class TileRenderer {
 public:
  // All have to outlive it.
  //   screen  `head` as `camera` sees it
  TileRenderer(const HeadScene& head, const RayFollower& follower, const ScreenScene& screen,
               const Camera& camera, const Eigen::Isometry3d& camera_from_head);

  // Traces samples of one tile. Neighbours in the list should be neighbours in the picture.
  //   edges  null, or with one sample a pixel: receives the pixels of the input and of the frame
  //          beside which (left, right, above, below, in this tile) something else is met, those
  //          beside them where the frame turns, and those whose way through glass ends at its edge.
  //          They will take more samples; here they get their kind only.
  void Trace(std::size_t tile, std::vector<CameraSample>& samples, std::vector<PixelState>& pixels,
             PixelFlags* edges = nullptr) const;

 private:
  // Fills batch.primary.
  void TracePrimary(std::size_t tile, const std::vector<CameraSample>& samples,
                    TileBatch& batch) const;
  void LeaveOutEdges(std::vector<CameraSample>& samples, TileBatch& batch, PixelFlags& edges) const;
  void TraceGloss(TileBatch& batch, const std::vector<CameraSample>& samples,
                  std::vector<PixelState>& pixels) const;
  void TraceExactly(std::size_t sample, const TileBatch& batch, std::vector<CameraSample>& samples,
                    std::vector<PixelState>& pixels) const;
  void Direct(std::size_t sample, const TileBatch& batch, std::vector<CameraSample>& samples,
              std::vector<PixelState>& pixels) const;

  const HeadScene& head_;
  const RayFollower& follower_;
  const ScreenScene& screen_;
  Camera camera_;
  Eigen::Matrix3f head_from_camera_;
  Eigen::Vector3d eye_;
};

}  // namespace lorgnette
