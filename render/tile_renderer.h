// SPDX-License-Identifier: Apache-2.0
// Samples of a tile, in batches: primary rays and what leaves the glass in packets of 16, lenses by
// the SIMD kernel; what meets a lens's edge goes the exact way of RayFollower. Internal to render/.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "render/ray_follower.h"
#include "render/tile_mask.h"

namespace lorgnette {

struct RayBundle;

// One camera ray, and what it brought.
struct CameraSample {
  float x = 0, y = 0;       // pixel position
  std::uint16_t pixel = 0;  // index into the tile's PixelStates

  enum class Kind : std::uint8_t {
    kBackground,
    kHead,
    kFrame,
    kLensToHead,        // through both surfaces ...
    kLensToBackground,  // ... past the head
    kLensElsewhere      // any other way through glass
  };
  Kind kind = Kind::kBackground;
  Eigen::Vector3f inserted{0, 0, 0};  // light of lens and frame
  Eigen::Vector3f direct{1, 1, 1};    // factor of the input pixel
};

class TileRenderer {
 public:
  TileRenderer(const HeadScene& head, const RayFollower& follower, const Camera& camera,
               const Eigen::Isometry3d& camera_from_head);

  // Traces the samples. Neighbours in the list should be neighbours in the picture.
  //   content  TileContent bits of the tile that holds them all
  void Trace(std::vector<CameraSample>& samples, std::uint8_t content,
             std::vector<PixelState>& pixels) const;

 private:
  struct Regular;
  struct Batch;
  void Share(std::size_t lens, float enter, float leave, const Eigen::Vector3f& direction,
             Regular& ray) const;
  void TracePrimary(RaySet set, Batch& batch, std::vector<CameraSample>& samples) const;
  void TraceGloss(Batch& batch, const std::vector<CameraSample>& samples,
                  std::vector<PixelState>& pixels) const;
  void TraceGloss(Batch& batch, const RayBundle& rays) const;
  void TraceLens(std::size_t lens, Batch& batch, std::vector<CameraSample>& samples,
                 std::vector<PixelState>& pixels) const;
  // The main rays whose colours part (batch.parted): each wavelength its own way. What is mirrored
  // keeps the d line's way.
  void TraceColours(std::size_t lens, Batch& batch, std::vector<CameraSample>& samples,
                    std::vector<PixelState>& pixels) const;
  bool PartsColours(std::size_t lens) const;
  // How far apart the ends of a main ray's colours may lie, pixels.
  float Parting(std::size_t lens, const Batch& batch, std::size_t main) const;
  void TraceExactly(std::size_t sample, const Batch& batch, std::vector<CameraSample>& samples,
                    std::vector<PixelState>& pixels) const;
  void Direct(std::size_t sample, const Batch& batch, std::vector<CameraSample>& samples,
              std::vector<PixelState>& pixels) const;

  const HeadScene& head_;
  const RayFollower& follower_;
  Camera camera_;
  Eigen::Matrix3f head_from_camera_;
  Eigen::Vector3d eye_;
};

}  // namespace lorgnette
