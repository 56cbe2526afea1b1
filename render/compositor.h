// SPDX-License-Identifier: Apache-2.0
// Puts worn eyeglasses into a picture of a face: refraction, reflection, shadow and the frame, by
// image-based rendering in linear light (paper, section V).
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "base/camera.h"
#include "base/image.h"
#include "base/mesh.h"
#include "base/result.h"
#include "geometry/eyewear.h"
#include "render/environment.h"

namespace lorgnette {

enum class ShadowMode {
  kNone,
  kPaper,  // Algorithm 1: stratified hemisphere rays at every shaded pixel
  kBaked,  // the same integral from visibility baked per point of the face
};

struct CompositorOptions {
  bool refraction = true;
  bool reflection = true;  // Fresnel: front and back surface, internal bounces
  ShadowMode shadow = ShadowMode::kBaked;
  bool shadow_sees_face = true;  // S_noGlasses with the face as an occluder (section V-B) or not
  int shadow_rays = 160;         // a pixel in paper mode (4 x 40 strata), a vertex when baked
  int samples_per_side = 2;      // 2: the paper's 2x2 samples a pixel
  bool adaptive = false;         // one sample where nothing changes
  int max_internal_bounces = 4;
  bool fade_temples = true;             // the paper's feathering toward the ears
  double background_distance_mm = 800;  // of what lies behind the head, from the head's origin
};

// The scene in head space, built once a clip; the camera moves.
class Compositor {
 public:
  // face: the mesh whose colours come from the input image. occluder: more of the head (skull,
  // ears) that hides temples and casts no picture; may be empty.
  static Result<Compositor> Create(const Eyewear& eyewear, const TriangleMesh& face,
                                   const TriangleMesh& occluder, const Environment& environment,
                                   const CompositorOptions& options);
  Compositor(Compositor&&) noexcept;
  ~Compositor();

  // Moves the face's vertices (same topology), for a frame with its own expression.
  void UpdateFace(const std::vector<Eigen::Vector3f>& vertices);

  // input and the result: linear light, the camera's size. world_from_camera turns directions for
  // the environment (the default world is the camera's, with y up and z toward the camera).
  ImageRgbF Render(const ImageRgbF& input, const Camera& camera,
                   const Eigen::Isometry3d& camera_from_head) const;

 private:
  struct Scene;
  explicit Compositor(std::unique_ptr<Scene> scene);
  std::unique_ptr<Scene> scene_;
};

}  // namespace lorgnette
