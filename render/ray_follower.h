// SPDX-License-Identifier: Apache-2.0
// The colour at the end of a ray in one frame: through glass, off glass, onto head, frame,
// background and environment (Whitted 1980). Internal to render/; thread safe.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "render/colour_bands.h"
#include "render/effects.h"
#include "render/gathered_shadow.h"
#include "render/head_scene.h"
#include "render/picture_view.h"

namespace lorgnette {

// Where a ray that the frame mirrors ends: nowhere, or on something of this radiance.
struct GlossEnd {
  bool away = false;
  Eigen::Vector3f radiance{0, 0, 0};  // of skin, or of the frame itself
};

// What one pixel's rays share.
struct PixelState {
  std::uint8_t band = 0;   // 0: the light has the media's own index (d line); k: ColourBands()[k-1]
  std::uint32_t seed = 0;  // of the paper's strata
  std::uint8_t side = 1;   // samples along each side of the pixel
  // The lens that the pixel's rays enter: how much smaller it shows the background.
  float minification = 1;
  long filled = 0;
  // Paper mode shades one point a pixel; nullopt until a ray of the pixel met the face.
  std::optional<Eigen::Vector3f> face_ratio;
  // Where the mirrored ray of the frame, seen directly, ends; nullopt until one was traced.
  std::optional<GlossEnd> frame_gloss;
};

class RayFollower {
 public:
  // `picture` and `head` have to outlive it.
  RayFollower(const HeadScene& head, const PictureView& picture, const Camera& camera,
              const Eigen::Isometry3d& camera_from_head, const PictureEffects& effects);

  const PictureView& picture() const { return picture_; }
  const EffectSet& effects(std::size_t lens) const { return effects_.lens[lens]; }
  double index(std::size_t lens, std::size_t band = 0) const { return index_[band][lens]; }
  const std::vector<ColourBand>& bands() const { return bands_; }
  // Dispersion of the lens is drawn where it moves a colour by more than this, in pixels.
  double dispersion_from_px(std::size_t lens) const { return effects_.dispersion_from_px[lens]; }
  // How many times smaller than beside it a lens shows the background, on its axis.
  float minification(std::size_t lens) const { return minification_[lens]; }
  // Coats and tint of a lens as they are drawn.
  const LensLook& look(std::size_t lens) const { return looks_[lens]; }

  // Whether a second internal reflection of this lens carries enough to be followed at every pixel.
  bool follows_ghosts(std::size_t lens) const;

  // First glass on a ray of head space that starts outside.
  struct Entry {
    std::size_t lens;
    Ray ray;  // lens frame
    SolidHit hit;
  };
  std::optional<Entry> FirstGlass(const Ray& ray) const;
  // Whether each wavelength goes its own way through a lens.
  bool parts_colours(std::size_t lens) const {
    return effects_.lens[lens][Effect::kDispersion] && effects_.lens[lens][Effect::kRefraction];
  }
  // Whether light can pass through both lenses on its way to this camera.
  bool lenses_overlap() const { return lenses_overlap_; }

  // Radiance along a ray (head space, unit direction) that starts outside all glass.
  //   weight       share of the pixel, for leaving out what cannot be seen
  //   transmitted  the ray left a lens by refraction: where it misses the head it sees the
  //                background; reflected rays see the environment
  Eigen::Vector3f Outside(const Ray& ray, double weight, int bounces, bool transmitted,
                          PixelState& pixel) const;
  // The same from the point where a ray enters a lens (lens frame).
  Eigen::Vector3f EnterGlass(std::size_t lens, const Ray& ray, const SolidHit& hit, double weight,
                             int bounces, PixelState& pixel) const;

  // The same from a point inside a lens or on its boundary, heading in (lens frame).
  Eigen::Vector3f Inside(std::size_t lens, const Ray& ray, double weight, int bounces,
                         PixelState& pixel) const;
  // What a ray outside all glass meets at `hit`, or past everything when it hit nothing.
  //   gloss  as for Frame
  Eigen::Vector3f AtHit(const SceneHit& hit, const Eigen::Vector3f& origin,
                        const Eigen::Vector3f& direction, bool transmitted, PixelState& pixel,
                        const std::optional<GlossEnd>& gloss = std::nullopt) const;

  Eigen::Vector3f EnvironmentLight(const Eigen::Vector3f& direction) const;
  // Light of the frame toward -direction, with the temples' feathering (render/frame_shading.cc).
  //   gloss  where its mirrored ray ends, where that is known
  Eigen::Vector3f Frame(const SceneHit& hit, const Eigen::Vector3f& point,
                        const Eigen::Vector3f& direction,
                        const std::optional<GlossEnd>& gloss = std::nullopt) const;
  // Share of the light behind the frame that comes through to -direction: 0 where it is opaque.
  Eigen::Vector3f FramePasses(const SceneHit& hit, const Eigen::Vector3f& point,
                              const Eigen::Vector3f& direction) const;
  // The ray that the frame mirrors, if it does; lifted off its own triangles.
  struct GlossRay {
    Eigen::Vector3f origin, direction;
    float cosine;  // between ray and normal
  };
  std::optional<GlossRay> GlossOf(const SceneHit& hit, const Eigen::Vector3f& point,
                                  const Eigen::Vector3f& direction) const;
  // Of a ray that GlossOf gave; and of what is mirrored at a point of the frame that is met from
  // inside a lens: it lies in the groove and sees no more than the groove.
  GlossEnd EndAt(const SceneHit& hit) const;
  // How far the frame's normal turns over a pixel there, radians.
  float TurnAt(const SceneHit& hit) const {
    return head_.frame.curvature[hit.triangle] * pixel_mm_;
  }
  // The edge wall as EdgeFinish::kGround.
  Eigen::Vector3f GroundEdge() const;
  // Radiance of the frame's triangles at their corners, without highlights.
  std::vector<Eigen::Vector3f> FrameRadiance() const;
  // Equation (2)'s factor at a point of the head.
  Eigen::Vector3f FaceRatio(const SceneHit& hit, const Eigen::Vector3f& point,
                            PixelState& pixel) const;

 private:
  // What a surface of the glass sends back and lets pass, and the share that is worth following.
  struct Split {
    Eigen::Vector3f reflected, passed;
  };
  Split AtSurface(std::size_t lens, SolidFace face, double reflectance, double cosine_in_air,
                  bool from_glass) const;
  // Whether a ray inside the glass (lens frame) next meets the wall, or the rim's reach of it.
  bool ReachesEdge(std::size_t lens, const Ray& ray) const;
  // The frame's surface at a hit.
  struct FramePoint {
    Eigen::Vector3f normal;
    Eigen::Vector3f diffuse;   // albedo
    Eigen::Vector3f specular;  // reflectance along the normal
    Eigen::Vector3f passed;    // share of what is not mirrored that goes through
    float cover = 1;           // share that is there at all
    float exponent = 1;        // of the lobe
    bool own_lobe = true;      // the part's, not a texture's
  };
  FramePoint FrameAt(const SceneHit& hit) const;
  Eigen::Vector3f FrameIrradiance(const SceneHit& hit) const;
  static std::optional<GlossRay> Gloss(const FramePoint& at, const Eigen::Vector3f& point,
                                       const Eigen::Vector3f& direction);
  // How much of the frame is left at a point: temples fade toward the ears.
  float FrameShare(const SceneHit& hit, const Eigen::Vector3f& point) const;
  // 1 at the front, 0 at the ears: how much of a temple beside this point is left.
  float TempleShare(const Eigen::Vector3f& point) const;
  Eigen::Vector3f Faded(const Eigen::Vector3f& ratio, const Eigen::Vector3f& point) const;
  Eigen::Vector3f Head(const SceneHit& hit, const Eigen::Vector3f& point, PixelState& pixel) const;
  Eigen::Vector3f Miss(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                       bool transmitted, PixelState& pixel) const;

  const HeadScene& head_;
  PictureEffects effects_;
  float pixel_mm_;  // at the head
  std::vector<ColourBand> bands_;
  std::vector<std::vector<double>> index_;  // by PixelState::band, then one a lens
  std::vector<LensLook> looks_;             // one a lens
  Eigen::Matrix3f world_from_head_;
  Eigen::Vector4f frame_z_{0, 0, 0, 0};  // of a point in head space (x, y, z, 1)
  bool lenses_overlap_ = false;
  std::vector<float> minification_;  // one a lens
  const PictureView& picture_;
  std::vector<Eigen::Vector3f> ratios_;            // one a baked point
  std::vector<Eigen::Vector3f> frame_irradiance_;  // one a vertex
  std::optional<GatheredShadow> gathered_;
};

}  // namespace lorgnette
