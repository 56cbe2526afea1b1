// SPDX-License-Identifier: Apache-2.0
#include "render/ray_follower.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/linear_algebra.h"
#include "base/units.h"
#include "optics/media.h"
#include "optics/trace.h"
#include "render/embree_scene.h"

namespace lorgnette {
namespace {

// A ground edge scatters what reaches it; about half of a matt wall's light comes back.
constexpr float kGroundEdgeAlbedo = 0.5f;

Ray Transformed(const Eigen::Isometry3d& to_from, const Ray& ray) {
  return {to_from * ray.origin, to_from.linear() * ray.direction};
}

// Thin lens of power F, camera L before it, background d behind it: the picture of the background
// shrinks by 1 - F d L / (d + L).
float Minification(const LensSolid& lens, const Eigen::Isometry3d& camera_from_head,
                   float background_depth_mm) {
  const double to_camera = (camera_from_head * lens.head_from_lens().translation()).z();
  const double behind = double(background_depth_mm) - to_camera;
  if (!(to_camera > 1) || !(behind > 1)) return 1;
  const Eigen::Vector2d power =
      (lens.lens().medium.index_d - 1) * SymmetricEigenvalues(lens.lens().front.VertexCurvature() -
                                                              lens.lens().back.VertexCurvature());
  const double reach = behind * to_camera / (behind + to_camera);
  return float((1 - reach * power.array()).abs().maxCoeff());
}

// Whether the pictures of the two lenses touch, with room for what refraction adds.
bool LensesOverlap(const HeadScene& head, const Camera& camera,
                   const Eigen::Isometry3d& camera_from_head) {
  if (head.lenses.size() < 2) return false;
  double low[2], high[2];
  for (std::size_t i = 0; i < 2; ++i) {
    low[i] = std::numeric_limits<double>::infinity();
    high[i] = -low[i];
    for (const Eigen::Vector2d& p : head.lenses[i].contour().polygon()) {
      const Eigen::Vector3d q =
          camera_from_head * head.lenses[i].head_from_lens() * Eigen::Vector3d(p.x(), p.y(), 0);
      if (q.z() <= 1) return true;
      const double x = camera.Project(q).x();
      low[i] = std::min(low[i], x);
      high[i] = std::max(high[i], x);
    }
  }
  const double room = 0.1 * std::max(high[0] - low[0], high[1] - low[1]);
  return low[0] < high[1] + room && low[1] < high[0] + room;
}

}  // namespace

RayFollower::RayFollower(const HeadScene& head, const PictureView& picture, const Camera& camera,
                         const Eigen::Isometry3d& camera_from_head, const PictureEffects& effects)
    : head_(head),
      effects_(effects),
      pixel_mm_(float(std::abs(camera_from_head.translation().z()) / camera.fx)),
      world_from_head_(
          (head.options.world_from_camera * camera_from_head.rotation()).cast<float>()),
      picture_(picture) {
  if (effects.Any(Effect::kDispersion)) bands_ = ColourBands(head.options.wavelengths);
  index_.resize(1 + bands_.size());
  for (std::size_t i = 0; i < head.lenses.size(); ++i) {
    const Medium& medium = head.lenses[i].lens().medium;
    index_[0].push_back(medium.index_d);
    for (std::size_t k = 0; k < bands_.size(); ++k) {
      index_[k + 1].push_back(IndexAt(medium, bands_[k].nm));
    }
    looks_.push_back(head.looks[i]);
    if (!effects.lens[i][Effect::kCoating]) looks_.back().front = looks_.back().back = {};
    if (!effects.lens[i][Effect::kTint]) looks_.back().tint = {};
  }
  for (const LensSolid& lens : head.lenses) {
    minification_.push_back(Minification(lens, camera_from_head, picture.background_depth()));
  }
  frame_z_ = head.frame.frame_from_head.matrix().row(2).cast<float>();
  const HeadLight light =
      LightAt(head.directions, head.cells, world_from_head_, float(head.options.environment_scale));
  tbb::parallel_invoke(
      [&] {
        if (head.baked_shadow && effects.rest[Effect::kShadow]) {
          ratios_ = head.baked_shadow->Relight(light);
        }
      },
      [&] { frame_irradiance_ = head.frame_light.Relight(light, picture_.face_mean()); });
  lenses_overlap_ = LensesOverlap(head, camera, camera_from_head);
  if (head.gather_lattice && effects.rest[Effect::kShadow]) {
    GatherScene gather{head.scene, head.face, head.directions, light, picture_.vertex_colours(),
                       {}};
    gather.frame_radiance = FrameRadiance();
    if (effects.Any(Effect::kLensLight)) {
      gather.lenses = &head.lenses;
      gather.looks = &looks_;
      gather.environment = &head.cells;
    }
    gather.world_from_head = world_from_head_;
    gather.environment_scale = float(head.options.environment_scale);
    gathered_ = GatheredShadow::Gather(gather, *head.gather_lattice);
  }
}

Eigen::Vector3f RayFollower::EnvironmentLight(const Eigen::Vector3f& direction) const {
  return float(head_.options.environment_scale) *
         head_.environment.Radiance(world_from_head_ * direction);
}

Eigen::Vector3f RayFollower::GroundEdge() const {
  return kGroundEdgeAlbedo * float(head_.options.environment_scale) * head_.environment_mean;
}

Eigen::Vector3f RayFollower::FaceRatio(const SceneHit& hit, const Eigen::Vector3f& point,
                                       PixelState& pixel) const {
  if (hit.object != SceneObject::kFace || !effects_.rest[Effect::kShadow]) {
    return Eigen::Vector3f::Ones();
  }
  if (gathered_) {
    if (!gathered_->touched(hit.triangle)) return Eigen::Vector3f::Ones();
    return Faded(gathered_->Ratio(hit.triangle, hit.u, hit.v), point);
  }
  if (head_.baked_shadow) {
    if (!head_.baked_shadow->touched(hit.triangle)) return Eigen::Vector3f::Ones();
    return Faded(head_.baked_shadow->Ratio(ratios_, hit.triangle, hit.u, hit.v), point);
  }
  if (!head_.paper_shadow) return Eigen::Vector3f::Ones();
  if (!pixel.face_ratio) {
    const Eigen::Vector3i& t = head_.face_triangles[hit.triangle];
    const Eigen::Vector3f normal = ((1 - hit.u - hit.v) * head_.face_normals[std::size_t(t[0])] +
                                    hit.u * head_.face_normals[std::size_t(t[1])] +
                                    hit.v * head_.face_normals[std::size_t(t[2])])
                                       .normalized();
    pixel.face_ratio = head_.paper_shadow->Ratio(head_.scene, head_.environment, world_from_head_,
                                                 {point, normal}, pixel.seed);
  }
  return Faded(*pixel.face_ratio, point);
}

// The shadow of a temple fades with the temple.
Eigen::Vector3f RayFollower::Faded(const Eigen::Vector3f& ratio,
                                   const Eigen::Vector3f& point) const {
  if (!head_.options.fade_temples) return ratio;
  const float share = TempleShare(point);
  if (share == 1) return ratio;
  return Eigen::Vector3f::Ones() - share * (Eigen::Vector3f::Ones() - ratio);
}

Eigen::Vector3f RayFollower::Head(const SceneHit& hit, const Eigen::Vector3f& point,
                                  PixelState& pixel) const {
  return picture_.Head(hit, point, pixel.filled).cwiseProduct(FaceRatio(hit, point, pixel));
}

Eigen::Vector3f RayFollower::Miss(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                                  bool transmitted, PixelState& pixel) const {
  Eigen::Vector3f colour;
  const float footprint = pixel.minification / float(pixel.side);
  if (transmitted && picture_.Background(origin, direction, footprint, colour, pixel.filled)) {
    return colour;
  }
  return EnvironmentLight(direction);
}

bool RayFollower::follows_ghosts(std::size_t lens) const {
  return FollowsGhosts(looks_[lens], index_[0][lens]);
}

std::optional<RayFollower::Entry> RayFollower::FirstGlass(const Ray& ray) const {
  std::optional<Entry> nearest;
  for (std::size_t i = 0; i < head_.lenses.size(); ++i) {
    const Ray local = Transformed(head_.lenses[i].lens_from_head(), ray);
    const auto hit = head_.lenses[i].Enter(local);
    if (hit && (!nearest || hit->distance < nearest->hit.distance)) nearest = Entry{i, local, *hit};
  }
  return nearest;
}

Eigen::Vector3f RayFollower::Outside(const Ray& ray, double weight, int bounces, bool transmitted,
                                     PixelState& pixel) const {
  const Eigen::Vector3f origin = ray.origin.cast<float>();
  const Eigen::Vector3f direction = ray.direction.cast<float>();
  const SceneHit hit = head_.scene.Intersect(RaySet::kAll, origin, direction, 0, kEndless);
  if (bounces <= head_.options.max_internal_bounces) {
    const auto glass = FirstGlass(ray);
    if (glass && (!hit.hit() || glass->hit.distance < double(hit.distance))) {
      return EnterGlass(glass->lens, glass->ray, glass->hit, weight, bounces + 1, pixel);
    }
  }
  return AtHit(hit, origin, direction, transmitted, pixel);
}

Eigen::Vector3f RayFollower::AtHit(const SceneHit& hit, const Eigen::Vector3f& origin,
                                   const Eigen::Vector3f& direction, bool transmitted,
                                   PixelState& pixel, const std::optional<GlossEnd>& gloss) const {
  if (!hit.hit()) return Miss(origin, direction, transmitted, pixel);
  const Eigen::Vector3f point = origin + hit.distance * direction;
  if (hit.object != SceneObject::kFrame) return Head(hit, point, pixel);
  Eigen::Vector3f colour = Frame(hit, point, direction, gloss);
  const Eigen::Vector3f passed = FramePasses(hit, point, direction);
  if (passed.maxCoeff() > 0) {
    const SceneHit behind = head_.scene.Intersect(RaySet::kHead, point, direction, 0, kEndless);
    colour +=
        passed.cwiseProduct(behind.hit() ? Head(behind, point + behind.distance * direction, pixel)
                                         : Miss(point, direction, transmitted, pixel));
  }
  return colour;
}

RayFollower::Split RayFollower::AtSurface(std::size_t lens, SolidFace face, double reflectance,
                                          double cosine_in_air, bool from_glass) const {
  const LensLook& look = looks_[lens];
  const SurfaceLook& surface = face == SolidFace::kBack ? look.back : look.front;
  if (face == SolidFace::kWall || surface.bare()) {
    return {Eigen::Vector3f::Constant(float(reflectance)),
            Eigen::Vector3f::Constant(float(1 - reflectance))};
  }
  const SurfaceLook::Power power =
      from_glass ? surface.FromGlass(float(cosine_in_air)) : surface.FromAir(float(cosine_in_air));
  return {power.reflected, power.passed};
}

Eigen::Vector3f RayFollower::EnterGlass(std::size_t lens, const Ray& ray, const SolidHit& hit,
                                        double weight, int bounces, PixelState& pixel) const {
  const LensSolid& solid = head_.lenses[lens];
  const EffectSet& on = effects_.lens[lens];
  pixel.minification = minification_[lens];
  const double cosine = std::min(-hit.normal.dot(ray.direction), 1.0);
  const double index = index_[pixel.band][lens];
  Split split = AtSurface(lens, hit.face, FresnelReflectance(cosine, 1 / index), cosine,
                          /*from_glass=*/false);
  const double reflected = weight * double(split.reflected.maxCoeff());
  Eigen::Vector3f colour = Eigen::Vector3f::Zero();
  if (on[Effect::kFrontReflection] && reflected >= head_.options.least_weight) {
    const Ray mirrored{hit.point, Reflect(ray.direction, hit.normal)};
    colour += split.reflected.cwiseProduct(
        Outside(Transformed(solid.head_from_lens(), mirrored), reflected, bounces, false, pixel));
  } else {
    split.passed += split.reflected;  // what is not followed is not lost either
  }
  Eigen::Vector3d direction = ray.direction;
  if (on[Effect::kRefraction]) {
    direction = Refract(ray.direction, hit.normal, 1 / index)->normalized();
  }
  return colour + split.passed.cwiseProduct(Inside(lens, {hit.point, direction},
                                                   weight * double(split.passed.maxCoeff()),
                                                   bounces, pixel));
}

Eigen::Vector3f RayFollower::Inside(std::size_t lens, const Ray& ray, double weight, int bounces,
                                    PixelState& pixel) const {
  const LensSolid& solid = head_.lenses[lens];
  const EffectSet& on = effects_.lens[lens];
  const auto hit = solid.Leave(ray);
  if (!hit) return Eigen::Vector3f::Zero();
  const ContourIndex& contour = solid.contour();
  const double depth = head_.rim_depth_mm[lens];
  const bool near_edge = contour.Clearance(ray.origin.x(), ray.origin.y()) < depth ||
                         contour.Clearance(hit->point.x(), hit->point.y()) < depth;
  if (near_edge) {
    const Ray in_head = Transformed(solid.head_from_lens(), ray);
    const Eigen::Vector3f origin = in_head.origin.cast<float>();
    const Eigen::Vector3f direction = in_head.direction.cast<float>();
    const SceneHit rim =
        head_.scene.Intersect(RaySet::kFrame, origin, direction, 0, float(hit->distance));
    if (rim.hit()) {
      const Eigen::Vector3f at = origin + rim.distance * direction;
      const Eigen::Vector3d point = ray.origin + double(rim.distance) * ray.direction;
      return looks_[lens]
          .tint.Between(ray.origin, point)
          .cwiseProduct(Frame(rim, at, direction, EndAt(rim)));
    }
  }
  const Eigen::Vector3f tint = looks_[lens].tint.Between(ray.origin, hit->point);
  if (hit->face == SolidFace::kWall && head_.options.finish.edge == EdgeFinish::kGround) {
    return tint.cwiseProduct(GroundEdge());
  }
  const double index = index_[pixel.band][lens];
  const double cosine = std::min(hit->normal.dot(ray.direction), 1.0);
  std::optional<Eigen::Vector3d> out = ray.direction;
  double reflectance, cosine_in_air = cosine;
  if (on[Effect::kRefraction]) {
    out = Refract(ray.direction, hit->normal, index);
    reflectance = out ? FresnelReflectance(cosine, index) : 1;
    if (out) cosine_in_air = std::min(std::abs(out->normalized().dot(hit->normal)), 1.0);
  } else {
    reflectance = FresnelReflectance(cosine, 1 / index);
  }
  Split split = {Eigen::Vector3f::Ones(), Eigen::Vector3f::Zero()};
  if (out) split = AtSurface(lens, hit->face, reflectance, cosine_in_air, /*from_glass=*/true);
  const double passed_by = weight * double(tint.maxCoeff());
  const double reflected = passed_by * double(split.reflected.maxCoeff());
  // Total reflection is no effect of its own: there is nothing else that the ray could do.
  const bool wanted = !out || on[bounces == 0 ? Effect::kBackReflection : Effect::kBounces];
  const bool follow = wanted && bounces <= head_.options.max_internal_bounces &&
                      reflected >= head_.options.least_weight;
  Eigen::Vector3f colour = Eigen::Vector3f::Zero();
  if (follow) {
    const Ray mirrored{hit->point, Reflect(ray.direction, hit->normal)};
    if (!out || on[Effect::kRings] || !ReachesEdge(lens, mirrored)) {
      colour += split.reflected.cwiseProduct(Inside(lens, mirrored, reflected, bounces + 1, pixel));
    } else {
      split.passed += split.reflected;
    }
  } else {
    split.passed += split.reflected;
  }
  if (out) {
    const Ray leaving = Transformed(solid.head_from_lens(), {hit->point, out->normalized()});
    colour += split.passed.cwiseProduct(
        Outside(leaving, passed_by * double(split.passed.maxCoeff()), bounces, true, pixel));
  }
  return tint.cwiseProduct(colour);
}

bool RayFollower::ReachesEdge(std::size_t lens, const Ray& ray) const {
  const auto hit = head_.lenses[lens].Leave(ray);
  return !hit || hit->face == SolidFace::kWall ||
         head_.lenses[lens].contour().Clearance(hit->point.x(), hit->point.y()) <
             head_.rim_depth_mm[lens];
}

}  // namespace lorgnette
