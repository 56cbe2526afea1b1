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
#include "render/effect_plan.h"
#include "render/environment.h"
#include "render/grain.h"
#include "render/input_picture.h"
#include "render/lens_finish.h"

namespace lorgnette {

enum class ShadowMode {
  kNone,
  kPaper,  // Algorithm 1: stratified hemisphere rays at every shaded pixel
  kBaked,  // the same integral from visibility baked per point of the face
  // Every direction of every point at this pose, with the light between skin and skin and, as an
  // effect, through the lenses: for stills.
  kGathered,
};

struct CompositorOptions {
  EffectSet effects = EffectSet::Paper();  // what Render draws unless it is told otherwise
  int wavelengths = 3;                     // of dispersion; a multiple of 3
  ShadowMode shadow = ShadowMode::kBaked;
  bool shadow_sees_face = true;    // S_noGlasses with the face as an occluder (section V-B) or not
  int shadow_rays = 160;           // a pixel in paper mode (4 x 40 strata)
  int shadow_directions = 1024;    // of the sphere, baked; a multiple of 16
  double shadow_spacing_mm = 1.5;  // between baked points where frame and skin are close
  int rebaked_points = 64;         // at most, each time the face moves but the first
  int samples_per_side = 2;        // 2: the paper's 2x2 samples a pixel
  bool adaptive = false;           // one sample where nothing changes
  int max_internal_bounces = 4;
  // A branch of the ray tree that carries less of its pixel is not followed: the third reflection
  // of uncoated glass carries 0.003.
  double least_weight = 0.004;
  LensFinish finish;  // coats, tint, edge
  // A lens's wall that stands this little before the frame is not seen: the bevel lies in the
  // groove, while the solid that is traced has the groove's size through all of its thickness.
  double bevel_mm = 1.5;
  bool fade_temples = true;             // the paper's feathering toward the ears
  double background_distance_mm = 800;  // of what lies behind the head, from the head's origin
  // Camera z of the background plane; given, it goes before background_distance_mm.
  std::optional<double> background_depth_mm;
  // Turns camera directions into those of the environment; the default has y up, z to the camera.
  Eigen::Matrix3d world_from_camera = Eigen::Vector3d(1, -1, -1).asDiagonal();
  CameraLook camera_look;        // of the video, for the effect kGrain
  double environment_scale = 1;  // radiance of the input image's 1.0 in units of the environment
};

struct TileMask;

// What one call of Render met.
struct RenderCounts {
  long lens_pixels = 0;      // pixels with at least one sample on a lens
  long frame_pixels = 0;     // ... on the frame
  long shadowed_pixels = 0;  // seen directly, with a ratio below 1
  long filled_samples = 0;   // rays that ended where the camera never saw
};

enum class HitCode {
  kBackground = 0,
  kRightLensToHead = 1,
  kLeftLensToHead = 2,
  kLensToBackground = 3,
  kFrame = 4,  // directly or through a lens
  kHead = 5,   // directly
  kEdge = 6,   // edge wall or total reflection: not followed further
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

  // Moves the face's vertices (same topology), for a frame with its own expression. Some of the
  // baked points follow: the result depends on the faces before.
  void UpdateFace(const std::vector<Eigen::Vector3f>& vertices);

  // input and the result: linear light, the camera's size. Pixels where nothing is inserted are
  // the input's, bit for bit; the result does not depend on the number of threads.
  //   effects  of this picture, in place of the options' set
  ImageRgbF Render(const ImageRgbF& input, const Camera& camera,
                   const Eigen::Isometry3d& camera_from_head, RenderCounts* counts = nullptr,
                   const PictureEffects* effects = nullptr) const;
  // The same from and to display-encoded pixels (render/color.h): DisplayFromLinear of the picture
  // above, exactly, without a linear copy of the whole picture.
  ImageRgb8 Render(const ImageRgb8& input, const Camera& camera,
                   const Eigen::Isometry3d& camera_from_head, RenderCounts* counts = nullptr,
                   const PictureEffects* effects = nullptr) const;
  // ... with the effects that the picture needs; `plan` receives them and why.
  ImageRgb8 Render(const ImageRgb8& input, const Camera& camera,
                   const Eigen::Isometry3d& camera_from_head, const EffectChoice& choice,
                   EffectPlan& plan, RenderCounts* counts = nullptr) const;

  // What this picture needs, by estimate and by wish (render/effect_plan.h).
  EffectPlan Plan(const InputPicture& input, const Camera& camera,
                  const Eigen::Isometry3d& camera_from_head, const EffectChoice& choice) const;

  // What the ray through every pixel's centre reaches: R, G, B the head-space point in mm where it
  // met the head through a lens by refraction at both surfaces, 0 elsewhere; A a HitCode.
  ImageRgbaF HitMap(const Camera& camera, const Eigen::Isometry3d& camera_from_head) const;

  // The environment_scale that gives a grey face (albedo 0.4) the mean radiance it has in `input`.
  double MatchExposure(const InputPicture& input, const Camera& camera,
                       const Eigen::Isometry3d& camera_from_head) const;
  void SetEnvironmentScale(double scale);
  void SetCameraLook(const CameraLook& look);

 private:
  struct Scene;
  class Canvas;
  struct Sitting;
  Sitting Sit(const ImageRgb8& input, const Camera& camera,
              const Eigen::Isometry3d& camera_from_head) const;
  void DrawLinear(const Sitting& sitting, const PictureEffects& effects, RenderCounts* counts,
                  ImageRgbF& picture, int x0, int y0) const;
  // Into a copy of the input.
  void DrawDisplay(const Sitting& sitting, const PictureEffects& effects, RenderCounts* counts,
                   ImageRgb8& output) const;
  RenderCounts Draw(const Sitting& sitting, const PictureEffects& effects, Canvas& canvas) const;
  explicit Compositor(std::unique_ptr<Scene> scene);
  std::unique_ptr<Scene> scene_;
};

}  // namespace lorgnette
