// SPDX-License-Identifier: Apache-2.0
// Light estimated from the shading of a face: harmonics of degree 2 fitted to the colours of the
// vertices that the camera sees (Ramamoorthi and Hanrahan, SIGGRAPH 2001), as far as skin is of one
// colour. Light from behind the face is not seen; a smoothness term fills it in. Tested on faces
// shaded by known light.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "base/camera.h"
#include "base/image.h"
#include "base/mesh.h"
#include "render/environment.h"

namespace lorgnette {

// Radiance in harmonics of degree 0..2, world axes of render/environment.h; its mean is that of
// skin of albedo 1.
struct FaceLight {
  static constexpr int kTerms = 9;
  std::array<Eigen::Vector3f, kTerms> radiance;
  double residual = 0;  // root mean square of the fit, as a share of the mean
  // Never below 0.
  Eigen::Vector3f At(const Eigen::Vector3f& world_direction) const;
};

// nullopt when fewer than 60 vertices are seen, or the face is black.
//   face  head space, with normals;  world_from_camera  CompositorOptions's
std::optional<FaceLight> FitFaceLight(const ImageRgbF& input, const Camera& camera,
                                      const Eigen::Isometry3d& camera_from_head,
                                      const TriangleMesh& face,
                                      const Eigen::Matrix3d& world_from_camera);

// The light alone, as a map; and a map whose own broad light is replaced by the face's, so that
// reflections keep its windows and lamps.
Environment EnvironmentOf(const FaceLight& light);
Environment Relit(const Environment& detail, const FaceLight& light);

}  // namespace lorgnette
