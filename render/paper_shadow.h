// SPDX-License-Identifier: Apache-2.0
// Algorithm 1 of the paper as it stands: at every shaded point, rays over the hemisphere; the
// oracle of the baked shadow.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "render/embree_scene.h"
#include "render/environment.h"
#include "render/lighting.h"

namespace lorgnette {

class PaperShadow {
 public:
  // rays: a point, stratified (render/directions.h). Jittered sets are made once and shared by
  // points with the same seed modulo kSets.
  PaperShadow(int rays, bool sees_face);

  // S_withGlasses / S_noGlasses by channel; exactly 1 where no ray meets the frame.
  Eigen::Vector3f Ratio(const EmbreeScene& scene, const Environment& environment,
                        const Eigen::Matrix3f& world_from_head, const SurfacePoint& point,
                        std::uint32_t seed) const;

  static constexpr std::uint32_t kSets = 64;

 private:
  // Directions about +z, padded to whole packets.
  struct Set {
    std::vector<float> x, y, z;
  };
  void Fill(const Set& set, std::size_t first, const Eigen::Vector3f& origin,
            const Eigen::Matrix3f& basis, RayPacket& packet) const;

  bool sees_face_;
  std::size_t rays_;
  std::vector<Set> sets_;
};

}  // namespace lorgnette
