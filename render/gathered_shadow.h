// SPDX-License-Identifier: Apache-2.0
// What glasses take from, and give to, the light on the skin, for one pose and one light: every
// direction of a point's hemisphere is followed, to the environment, through a lens, or to other
// skin. The stills' way; slower than BakedShadow and without its harmonics. Internal to render/.
//
// ratio = (D_with + I_with) / (D_without + I_without). D: light of the environment that reaches the
// point. I: light that other skin sends there, read from the picture, which already holds it;
// behind glasses it is less by that skin's own ratio. Skin's albedo cancels. Directions that pass a
// lens bring, on request, what the environment sends along the refracted ray, times the lens's
// transmittance: light is gathered from the caustic's source, so that nothing has to be shot.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "render/embree_scene.h"
#include "render/environment.h"
#include "render/face_lattice.h"
#include "render/lens_finish.h"
#include "render/lens_solid.h"
#include "render/lighting.h"

namespace lorgnette {

struct GatherScene {
  const EmbreeScene& scene;
  const TriangleMesh& face;                        // head space, with normals
  const std::vector<Eigen::Vector3f>& directions;  // of the sphere; a multiple of 16
  const HeadLight& light;                          // of those directions
  // Radiance of the face's vertices in the picture, and of the frame's corners, three a triangle.
  const std::vector<Eigen::Vector3f>& face_radiance;
  std::vector<Eigen::Vector3f> frame_radiance = {};
  // Light through the lenses; without lenses they are passed as if they were absent.
  const std::vector<LensSolid>* lenses = nullptr;
  const std::vector<LensLook>* looks = nullptr;
  const BlurredEnvironment* environment = nullptr;
  Eigen::Matrix3f world_from_head = Eigen::Matrix3f::Identity();
  float environment_scale = 1;
};

class GatheredShadow {
 public:
  // Light that comes from skin needs a pass for each bounce behind the glasses.
  static constexpr int kBounces = 2;
  static GatheredShadow Gather(const GatherScene& scene, FaceLattice lattice);

  bool touched(std::uint32_t triangle) const { return lattice_.touched(triangle); }
  Eigen::Vector3f Ratio(std::uint32_t triangle, float u, float v) const {
    return lattice_.Interpolate(values_, triangle, u, v);
  }

 private:
  FaceLattice lattice_;
  std::vector<Eigen::Vector3f> values_;
};

}  // namespace lorgnette
