// SPDX-License-Identifier: Apache-2.0
// One lens's part of a tile's samples: through both surfaces by the SIMD kernel, what leaves the
// glass in packets of 16. Internal to render/.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "render/camera_sample.h"
#include "render/ray_follower.h"
#include "render/tile_batch.h"

namespace lorgnette {

class LensPass {
 public:
  // batch.primary has been traced; samples and pixels are those of the tile.
  //   eye  the camera, head space
  LensPass(const HeadScene& head, const RayFollower& follower, const Camera& camera,
           const Eigen::Vector3d& eye, std::size_t lens, TileBatch& batch,
           std::vector<CameraSample>& samples, std::vector<PixelState>& pixels);

  // Finds the samples that enter by the first surface (batch.regular), and batch.lens_of for them
  // and for those that have to be traced exactly.
  void Enter();
  // Fills the samples of batch.regular.
  void Shade();

 private:
  // The samples that may touch the glass, through the kernel. False: none does.
  bool ThroughKernel();
  // What each ray does after the first surface; certainly beside the glass; or none of these.
  void SortOut();
  // How far from the front the ground wall cuts a ray off that would meet the back beside the
  // contour. Nothing: it does not, or the wall is polished.
  std::optional<float> WayToWall(std::size_t k, const ContourIndex::Place& at1,
                                 const ContourIndex::Place& at2) const;
  // How the light of a ray through both surfaces is shared out. `enter`, `leave`: reflectances of
  // bare glass.
  void Share(float enter, float leave, const Eigen::Vector3f& direction, LensRay& ray) const;
  // Mirrored by the front; gone through or to the wall, unless the frame's reach into the glass
  // lies between.
  void Divide();
  // Mirrored by the back: out through the front, to the wall, or the exact way.
  void SendBack();
  // What all of these rays meet, into the samples.
  void Gather();
  // Where the frame mirrors the rays of a bundle that meet it, into batch.gloss_ends.
  void TraceGloss(const RayBundle& rays);
  // The main rays whose colours part (batch.parted): each wavelength its own way. What is mirrored
  // keeps the d line's way.
  void TraceColours();
  // How far apart the ends of a main ray's colours may lie, pixels.
  float Parting(std::size_t main) const;

  Eigen::Vector3f ToHead(const Eigen::Vector3f& p) const {
    return head_from_lens_ * p + lens_in_head_;
  }
  // Of bare glass that the ray enters, for light that is not refracted.
  float MirroredShare(const RayColumns& rays, const RayColumns& normals, std::size_t k) const;

  const HeadScene& head_;
  const RayFollower& follower_;
  const Camera& camera_;
  Eigen::Vector3d eye_;
  std::size_t lens_;
  TileBatch& batch_;
  std::vector<CameraSample>& samples_;
  std::vector<PixelState>& pixels_;

  const LensSolid& solid_;
  const LensLook& look_;
  bool refracts_;  // else rays pass as through air, and mirror as glass does that they enter so
  double index_, bend_;
  double rim_depth_;  // of the frame's reach into the glass
  Eigen::Matrix3f lens_from_head_, head_from_lens_;
  Eigen::Vector3f lens_in_head_;
  float shift_ = 0;  // of the kernel's rays from the eye toward the glass, mm
};

}  // namespace lorgnette
