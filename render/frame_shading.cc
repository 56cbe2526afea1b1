// SPDX-License-Identifier: Apache-2.0
// The frame as a ray sees it: Phong (paper, section V-A), or metallic-roughness with textures where
// its model brings them (glTF 2.0, appendix B: Schlick's Fresnel term over the mirrored share, the
// rest diffuse, or let through).
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "render/embree_scene.h"
#include "render/ray_follower.h"

namespace lorgnette {
namespace {

float SmoothStep(double x, double from, double to) {
  const double s = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return float(s * s * (3 - 2 * s));
}

// Reflectance toward grazing (Schlick 1994). A rough surface, whose lobe is wide, does not become a
// mirror there: its facets hide each other.
Eigen::Vector3f Schlick(const Eigen::Vector3f& along_normal, float cosine, float exponent) {
  const float off = 1 - cosine;
  const float rise = off * off * off * off * off;
  const float roughness = std::sqrt(std::sqrt(2 / (exponent + 2)));
  const Eigen::Vector3f most = along_normal.cwiseMax(1 - roughness);
  return along_normal + rise * (most - along_normal);
}

// Of a cosine of incidence on a rounded edge, as the mean over a sample's width counts it. Toward
// the silhouette of a cylinder the squared cosine grows in proportion to the distance from it, by
// `rate` over that width; a sample there stands for what lies between the silhouette and its own
// far side. Without this single samples that graze an edge sparkle.
float MeanCosine(float cosine, float rate) {
  const float squared = cosine * cosine;
  return squared >= rate ? cosine : std::min(std::sqrt(0.5f * (squared + rate)), 1.0f);
}

// Exponent of a Phong lobe (variance 1 / exponent) as wide as what one sample sees of it where the
// normal turns by `turn` over the sample's width, and the mirrored ray by twice as much: the
// variance of that turn, along one of two axes, is added (after Kaplanyan et al. 2016).
float WidenedExponent(float exponent, float turn) {
  const float variance = (2 * turn) * (2 * turn) / 12;
  return std::max(1 / (1 / std::max(exponent, 1.0f) + 0.5f * variance), 1.0f);
}

// The normal that a tangent-space texture asks for. v of the texture runs downwards, its y up.
Eigen::Vector3f Bumped(const TriangleMesh& mesh, const Eigen::Vector3i& t,
                       const Eigen::Vector2f& uv, const Eigen::Vector3f& normal,
                       const PbrMaterial& material) {
  const auto position = [&](int k) { return mesh.positions[std::size_t(t[k])].cast<float>(); };
  const Eigen::Vector3f e1 = position(1) - position(0), e2 = position(2) - position(0);
  const Eigen::Vector2f d1 = mesh.uvs[std::size_t(t[1])] - mesh.uvs[std::size_t(t[0])];
  const Eigen::Vector2f d2 = mesh.uvs[std::size_t(t[2])] - mesh.uvs[std::size_t(t[0])];
  const float area = d1.x() * d2.y() - d2.x() * d1.y();
  if (std::abs(area) < 1e-12f) return normal;
  Eigen::Vector3f along = (d2.y() * e1 - d1.y() * e2) / area;
  along -= along.dot(normal) * normal;
  if (along.squaredNorm() < 1e-12f) return normal;
  along.normalize();
  Eigen::Vector3f up = normal.cross(along);
  const Eigen::Vector3f down = (d1.x() * e2 - d2.x() * e1) / area;
  if (up.dot(down) > 0) up = -up;
  const Eigen::Vector4f texel = SampleTexture(*material.normal_texture, uv);
  const Eigen::Vector3f n = 2 * texel.head<3>() - Eigen::Vector3f::Ones();
  return (material.normal_scale * (n.x() * along + n.y() * up) + n.z() * normal).normalized();
}

}  // namespace

RayFollower::FramePoint RayFollower::FrameAt(const SceneHit& hit) const {
  const FrameSurface& frame = head_.frame;
  const FrameMaterial& material = frame.materials[frame.material_of[hit.triangle]];
  const Eigen::Vector3i& t = frame.mesh.triangles[hit.triangle];
  const float w[3] = {1 - hit.u - hit.v, hit.u, hit.v};
  FramePoint at;
  at.normal.setZero();
  for (int k = 0; k < 3; ++k) at.normal += w[k] * frame.normals[std::size_t(t[k])];
  at.normal.normalize();
  at.diffuse = material.diffuse;
  at.specular = material.specular;
  at.exponent = material.shininess;
  at.passed.setZero();
  if (material.pbr == nullptr) return at;
  const PbrMaterial& pbr = *material.pbr;
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  for (int k = 0; k < 3; ++k) uv += w[k] * frame.mesh.uvs[std::size_t(t[k])];
  if (pbr.normal_texture) at.normal = Bumped(frame.mesh, t, uv, at.normal, pbr);
  const PbrPoint point = EvaluatePbr(pbr, uv);
  const float mirrored = std::pow((pbr.ior - 1) / (pbr.ior + 1), 2.0f);
  const float metallic = std::clamp(point.metallic, 0.0f, 1.0f);
  at.specular = Eigen::Vector3f::Constant(mirrored * (1 - metallic)) + metallic * point.base_color;
  at.diffuse = (1 - metallic) * (1 - point.transmission) * point.base_color;
  at.passed = (1 - metallic) * point.transmission * point.base_color;
  at.cover = std::clamp(point.alpha, 0.0f, 1.0f);
  if (pbr.metallic_roughness_texture) {
    at.exponent = LobeExponent(point.roughness);
    at.own_lobe = false;
  }
  return at;
}

std::vector<Eigen::Vector3f> RayFollower::FrameRadiance() const {
  const FrameSurface& frame = head_.frame;
  std::vector<Eigen::Vector3f> radiance;
  for (std::size_t t = 0; t < frame.mesh.triangles.size(); ++t) {
    const FrameMaterial& material = frame.materials[frame.material_of[t]];
    for (int k = 0; k < 3; ++k) {
      radiance.push_back(float(1 / kPi) *
                         material.diffuse.cwiseProduct(
                             frame_irradiance_[std::size_t(frame.mesh.triangles[t][k])]));
    }
  }
  return radiance;
}

Eigen::Vector3f RayFollower::FrameIrradiance(const SceneHit& hit) const {
  const Eigen::Vector3i& t = head_.frame.mesh.triangles[hit.triangle];
  return (1 - hit.u - hit.v) * frame_irradiance_[std::size_t(t[0])] +
         hit.u * frame_irradiance_[std::size_t(t[1])] +
         hit.v * frame_irradiance_[std::size_t(t[2])];
}

float RayFollower::FrameShare(const SceneHit& hit, const Eigen::Vector3f& point) const {
  if (!head_.options.fade_temples || !head_.frame.fades[head_.frame.material_of[hit.triangle]]) {
    return 1;
  }
  return TempleShare(point);
}

float RayFollower::TempleShare(const Eigen::Vector3f& point) const {
  const float z = frame_z_.head<3>().dot(point) + frame_z_.w();
  return 1 - SmoothStep(-double(z), -head_.frame.fade_start_z, -head_.frame.fade_end_z);
}

Eigen::Vector3f RayFollower::FramePasses(const SceneHit& hit, const Eigen::Vector3f& point,
                                         const Eigen::Vector3f& direction) const {
  const float share = FrameShare(hit, point);
  if (head_.frame.materials[head_.frame.material_of[hit.triangle]].pbr == nullptr) {
    return Eigen::Vector3f::Constant(1 - share);
  }
  const FramePoint at = FrameAt(hit);
  const Eigen::Vector3f mirrored =
      Schlick(at.specular, std::min(std::abs(at.normal.dot(direction)), 1.0f), at.exponent);
  const Eigen::Vector3f through =
      at.cover * (Eigen::Vector3f::Ones() - mirrored).cwiseProduct(at.passed);
  return Eigen::Vector3f::Constant(1 - share * at.cover) + share * through;
}

std::optional<RayFollower::GlossRay> RayFollower::Gloss(const FramePoint& at,
                                                        const Eigen::Vector3f& point,
                                                        const Eigen::Vector3f& direction) {
  if (at.specular.isZero()) return std::nullopt;
  const float along = at.normal.dot(direction);
  const Eigen::Vector3f mirrored = direction - 2 * along * at.normal;
  if (!(mirrored.dot(at.normal) * along < 0)) return std::nullopt;
  // Smooth normals mirror rays into the flat triangles beside them.
  constexpr float kLift_mm = 0.1f, kOwnTriangles_mm = 2;
  return GlossRay{point - std::copysign(kLift_mm, along) * at.normal + kOwnTriangles_mm * mirrored,
                  mirrored, std::min(std::abs(along), 1.0f)};
}

GlossEnd RayFollower::EndAt(const SceneHit& hit) const {
  if (!hit.hit()) return {true, Eigen::Vector3f::Zero()};
  if (hit.object == SceneObject::kFrame) {
    // Mirrored once more, but without a ray: as if the surface there were matt.
    const FramePoint at = FrameAt(hit);
    return {false, float(1 / kPi) * (at.diffuse + at.specular).cwiseProduct(FrameIrradiance(hit))};
  }
  if (hit.object != SceneObject::kFace) return {false, picture_.face_mean()};
  const Eigen::Vector3i& t = head_.face_triangles[hit.triangle];
  const std::vector<Eigen::Vector3f>& skin = picture_.vertex_colours();
  return {false, (1 - hit.u - hit.v) * skin[std::size_t(t[0])] + hit.u * skin[std::size_t(t[1])] +
                     hit.v * skin[std::size_t(t[2])]};
}

std::optional<RayFollower::GlossRay> RayFollower::GlossOf(const SceneHit& hit,
                                                          const Eigen::Vector3f& point,
                                                          const Eigen::Vector3f& direction) const {
  if (!effects_.rest[Effect::kGloss]) return std::nullopt;
  return Gloss(FrameAt(hit), point, direction);
}

Eigen::Vector3f RayFollower::Frame(const SceneHit& hit, const Eigen::Vector3f& point,
                                   const Eigen::Vector3f& direction,
                                   const std::optional<GlossEnd>& gloss) const {
  const float share = FrameShare(hit, point);
  if (share == 0) return Eigen::Vector3f::Zero();
  const FrameSurface& frame = head_.frame;
  const std::uint16_t part = frame.material_of[hit.triangle];
  const FramePoint at = FrameAt(hit);
  Eigen::Vector3f colour = float(1 / kPi) * at.diffuse.cwiseProduct(FrameIrradiance(hit));
  if (effects_.rest[Effect::kGloss]) {
    if (const auto ray = Gloss(at, point, direction)) {
      const GlossEnd end = gloss ? *gloss
                                 : EndAt(head_.scene.Intersect(RaySet::kAll, ray->origin,
                                                               ray->direction, 0, kEndless));
      const float turn = 0.5f * TurnAt(hit);  // pixels at an edge have two samples a side
      const float cosine = MeanCosine(ray->cosine, turn);
      Eigen::Vector3f mirrored = end.radiance;
      if (end.away) {
        const Eigen::Vector3f world = world_from_head_ * ray->direction;
        const float lobe = WidenedExponent(at.exponent, turn / cosine);
        mirrored = float(head_.options.environment_scale) *
                   (at.own_lobe ? frame.OwnGlossAt(part, lobe, world) : frame.GlossAt(lobe, world));
      }
      colour += Schlick(at.specular, cosine, at.exponent).cwiseProduct(mirrored);
    }
  }
  return share * at.cover * colour;
}

}  // namespace lorgnette
