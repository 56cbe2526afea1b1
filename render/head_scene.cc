// SPDX-License-Identifier: Apache-2.0
#include "render/head_scene.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>

#include "geometry/mesh_check.h"

namespace lorgnette {
namespace {

constexpr int kLightDirections = 1024;
constexpr int kFrameDirections = 128;
// The paper's feathering: share of the way from the front to the ear.
constexpr double kFadeStart = 0.55, kFadeEnd = 0.97;

bool IsDrawn(const FramePart& part) {
  return part.kind != FramePartKind::kDemoLens && !part.mesh.empty();
}

// Sides of slivers say nothing of how a surface turns over a pixel.
constexpr double kLeastSide_mm = 0.1;

// Of the parts that are drawn: whether each is closed and faces outwards.
std::vector<std::uint8_t> SolidParts(const FrameModel& frame) {
  std::vector<const TriangleMesh*> drawn;
  for (const FramePart& part : frame.parts) {
    if (IsDrawn(part)) drawn.push_back(&part.mesh);
  }
  std::vector<std::uint8_t> solid(drawn.size());
  tbb::parallel_for(std::size_t(0), drawn.size(), [&](std::size_t i) {
    const MeshReport report = CheckMesh(*drawn[i], /*find_self_intersections=*/false);
    solid[i] = report.closed() && report.least_part_mm3 > 0;
  });
  return solid;
}

FrameSurface JoinParts(const Eyewear& eyewear) {
  FrameSurface out;
  out.frame_from_head = eyewear.head_from_frame.inverse();
  for (const FramePart& part : eyewear.frame.parts) {
    if (!IsDrawn(part)) continue;
    const TriangleMesh& mesh = part.mesh;
    const Eigen::Vector3i first = Eigen::Vector3i::Constant(int(out.mesh.positions.size()));
    for (const Eigen::Vector3d& p : mesh.positions) {
      out.mesh.positions.push_back(eyewear.head_from_frame * p);
    }
    for (const Eigen::Vector3i& t : mesh.triangles) out.mesh.triangles.push_back(t + first);
    std::vector<Eigen::Vector3d> computed;
    if (mesh.normals.size() != mesh.positions.size()) {
      TriangleMesh bare;
      bare.positions = mesh.positions;
      bare.triangles = mesh.triangles;
      ComputeVertexNormals(bare);
      computed = std::move(bare.normals);
    }
    for (const Eigen::Vector3d& n : computed.empty() ? mesh.normals : computed) {
      out.mesh.normals.push_back(eyewear.head_from_frame.rotation() * n);
    }
    out.mesh.uvs.insert(out.mesh.uvs.end(), mesh.uvs.begin(), mesh.uvs.end());
    out.mesh.uvs.resize(out.mesh.positions.size(), Eigen::Vector2f::Zero());
    out.material_of.insert(out.material_of.end(), mesh.triangles.size(),
                           std::uint16_t(out.materials.size()));
    out.materials.push_back(part.material);
    out.fades.push_back(part.kind == FramePartKind::kTemple);
  }
  out.solid = SolidParts(eyewear.frame);
  for (const Eigen::Vector3d& n : out.mesh.normals) out.normals.push_back(n.cast<float>());
  for (const Eigen::Vector3i& t : out.mesh.triangles) {
    double most = 0;
    for (int k = 0; k < 3; ++k) {
      const std::size_t a = std::size_t(t[k]), b = std::size_t(t[(k + 1) % 3]);
      const double side = (out.mesh.positions[a] - out.mesh.positions[b]).norm();
      const double turn = (out.mesh.normals[a] - out.mesh.normals[b]).norm();
      most = std::max(most, turn / std::max(side, kLeastSide_mm));
    }
    out.curvature.push_back(float(most));
  }
  double ear_z = 0.5 * (eyewear.frame.ear_point_right.z() + eyewear.frame.ear_point_left.z());
  if (ear_z >= 0) ear_z = -0.7 * eyewear.frame.temple_length_mm;
  out.fade_start_z = kFadeStart * ear_z;
  out.fade_end_z = kFadeEnd * ear_z;
  return out;
}

VisibleMesh JoinVisible(const TriangleMesh& face, const TriangleMesh& occluder,
                        const TriangleMesh& frame) {
  VisibleMesh out;
  const auto append = [&out](const TriangleMesh& mesh) {
    const Eigen::Vector3i first = Eigen::Vector3i::Constant(int(out.vertices.size()));
    for (const Eigen::Vector3d& p : mesh.positions) out.vertices.push_back(p.cast<float>());
    for (const Eigen::Vector3i& t : mesh.triangles) out.triangles.push_back(t + first);
  };
  append(face);
  out.first_occluder = out.triangles.size();
  append(occluder);
  out.first_frame = out.triangles.size();
  append(frame);
  return out;
}

// The environment under the lobes that the frame's materials have.
void BlurForGloss(const Environment& environment, FrameSurface& frame) {
  std::vector<float> known;
  bool textured = false;
  for (const FrameMaterial& material : frame.materials) {
    const auto found = std::find(known.begin(), known.end(), material.shininess);
    frame.gloss_of.push_back(std::uint16_t(found - known.begin()));
    if (found == known.end()) {
      known.push_back(material.shininess);
      frame.gloss.push_back(BlurredEnvironment::ForPhong(environment, material.shininess));
    }
    textured = textured ||
               (material.pbr != nullptr && material.pbr->metallic_roughness_texture != nullptr);
  }
  for (double exponent = 1; exponent <= (textured ? 1024 : 64); exponent *= 4) {
    frame.lobes.push_back(BlurredEnvironment::ForPhong(environment, exponent));
  }
}

// Greatest distance from the contour, inward, of a point of the frame that lies inside the glass.
double RimDepth(const LensSolid& lens, const TriangleMesh& frame) {
  double depth = 0;
  for (const Eigen::Vector3i& t : frame.triangles) {
    for (int k = 0; k < 3; ++k) {
      // Corners and the middles of the sides: triangles of a rim are small against its radius.
      const Eigen::Vector3d& a = frame.positions[std::size_t(t[k])];
      const Eigen::Vector3d& b = frame.positions[std::size_t(t[(k + 1) % 3])];
      for (const Eigen::Vector3d& p : {a, Eigen::Vector3d(0.5 * (a + b))}) {
        const Eigen::Vector3d q = lens.lens_from_head() * p;
        if (q.z() < lens.low().z() - 0.5 || q.z() > lens.high().z() + 0.5) continue;
        depth = std::max(depth, lens.contour().Clearance(q.x(), q.y()));
      }
    }
  }
  constexpr double kMargin_mm = 1.0;  // Clearance is up to one grid cell short
  return depth + kMargin_mm;
}

}  // namespace

Eigen::Vector3f FrameSurface::GlossAt(float exponent, const Eigen::Vector3f& direction) const {
  // Each lobe has four times the exponent of the one before: half its width.
  const float at =
      std::clamp(0.5f * std::log2(std::max(exponent, 1.0f)), 0.0f, float(lobes.size() - 1));
  const std::size_t low = std::min(std::size_t(at), lobes.size() - 2);
  const float share = at - float(low);
  return (1 - share) * lobes[low].Radiance(direction) + share * lobes[low + 1].Radiance(direction);
}

Eigen::Vector3f FrameSurface::OwnGlossAt(std::size_t part, float exponent,
                                         const Eigen::Vector3f& direction) const {
  // One octave to go over from the part's own table to those of all.
  const float share = std::min(std::log2(float(materials[part].shininess) / exponent), 1.0f);
  if (share >= 1) return GlossAt(exponent, direction);
  const Eigen::Vector3f own = gloss[gloss_of[part]].Radiance(direction);
  return share > 0 ? Eigen::Vector3f((1 - share) * own + share * GlossAt(exponent, direction))
                   : own;
}

Result<HeadScene> HeadScene::Build(const Eyewear& eyewear, const TriangleMesh& face,
                                   const TriangleMesh& occluder, const Environment& environment,
                                   const CompositorOptions& options) {
  if (face.empty()) return Failure("the face mesh has no triangles");
  for (const TriangleMesh* mesh : {&face, &occluder}) {
    for (const Eigen::Vector3i& t : mesh->triangles) {
      if (t.minCoeff() < 0 || t.maxCoeff() >= int(mesh->positions.size())) {
        return Failure(fmt::format("a triangle of the face names vertex {}, want 0..{}",
                                   t.maxCoeff(), mesh->positions.size() - 1));
      }
    }
  }
  if (options.samples_per_side < 1 || options.samples_per_side > 32) {
    return UsageError(fmt::format("samples a side: got {}, want 1..32", options.samples_per_side));
  }
  if (options.shadow_directions < 16 || options.shadow_directions % 16 != 0) {
    return UsageError(
        fmt::format("shadow directions: got {}, want a multiple of 16", options.shadow_directions));
  }
  if (options.wavelengths < 3 || options.wavelengths % 3 != 0) {
    return UsageError(
        fmt::format("wavelengths: got {}, want a multiple of 3", options.wavelengths));
  }
  const bool own_directions =
      options.shadow == ShadowMode::kBaked || options.shadow == ShadowMode::kGathered;
  const int directions = own_directions ? options.shadow_directions : kLightDirections;
  TriangleMesh smooth_face = face;
  if (smooth_face.normals.size() != smooth_face.positions.size()) ComputeVertexNormals(smooth_face);
  const CutLens* const cuts[2] = {&eyewear.right, &eyewear.left};
  for (const CutLens* cut : cuts) {
    if (cut->contour_mm.size() < 3) {
      return Failure(
          fmt::format("a lens contour has {} points, want 3 or more", cut->contour_mm.size()));
    }
  }
  FrameSurface frame;
  std::optional<LensSolid> solids[2];
  std::optional<BlurredEnvironment> cells;
  const auto solid = [&](int k) {
    solids[k].emplace(cuts[k]->lens.lens(), cuts[k]->contour_mm,
                      eyewear.head_from_frame * cuts[k]->frame_from_lens);
  };
  std::optional<Result<EmbreeScene>> built;
  const auto join = [&] {
    frame = JoinParts(eyewear);
    tbb::parallel_invoke([&] { built = EmbreeScene::Build(smooth_face, occluder, frame.mesh); },
                         [&] { BlurForGloss(environment, frame); });
  };
  tbb::parallel_invoke(
      join, [&] { solid(0); }, [&] { solid(1); },
      [&] { cells = BlurredEnvironment::ForCells(environment, directions); });
  LG_ASSIGN(EmbreeScene scene, *std::move(built));

  std::vector<LensSolid> lenses;
  for (std::optional<LensSolid>& made : solids) lenses.push_back(*std::move(made));
  std::vector<LensLook> looks;
  for (const LensSolid& lens : lenses) {
    looks.push_back(
        LookOf(options.finish, lens.lens().medium.index_d, lens.high().y(), lens.low().y()));
  }

  std::vector<double> rim_depth(lenses.size());
  BakedIrradiance frame_light;
  VisibleMesh visible;
  std::optional<BakedShadow> baked_shadow;
  std::optional<PaperShadow> paper_shadow;
  std::optional<FaceLattice> gather_lattice;
  const auto cast_shadow = [&] {
    const double near_mm = options.shadow_spacing_mm, far_mm = 4 * near_mm;
    if (options.shadow == ShadowMode::kBaked) {
      ShadowOptions shadow;
      shadow.sees_face = options.shadow_sees_face;
      shadow.directions = directions;
      shadow.spacing_near_mm = near_mm;
      shadow.spacing_far_mm = far_mm;
      baked_shadow = BakedShadow::Bake(scene, smooth_face, frame.mesh, shadow);
    } else if (options.shadow == ShadowMode::kPaper) {
      paper_shadow.emplace(options.shadow_rays, options.shadow_sees_face);
    } else if (options.shadow == ShadowMode::kGathered) {
      gather_lattice.emplace(smooth_face, frame.mesh, near_mm, far_mm);
    }
  };
  // Each has stretches for one thread; side by side they leave none idle.
  tbb::parallel_invoke(
      [&] { frame_light = BakedIrradiance::Bake(scene, frame.mesh, kFrameDirections); },
      cast_shadow,
      [&] {
        for (std::size_t i = 0; i < lenses.size(); ++i) {
          rim_depth[i] = RimDepth(lenses[i], frame.mesh);
        }
        visible = JoinVisible(smooth_face, occluder, frame.mesh);
      });

  std::vector<Eigen::Vector3f> vertices, normals;
  for (const Eigen::Vector3d& p : smooth_face.positions) vertices.push_back(p.cast<float>());
  for (const Eigen::Vector3d& n : smooth_face.normals) normals.push_back(n.cast<float>());
  return HeadScene{options,
                   std::move(scene),
                   smooth_face,
                   std::move(vertices),
                   std::move(normals),
                   smooth_face.triangles,
                   std::move(frame),
                   std::move(visible),
                   std::move(lenses),
                   std::move(looks),
                   std::move(rim_depth),
                   environment,
                   environment.Mean(),
                   BrightestLight(environment),
                   SphereDirections(directions),
                   *std::move(cells),
                   std::move(frame_light),
                   std::move(baked_shadow),
                   std::move(paper_shadow),
                   std::move(gather_lattice)};
}

}  // namespace lorgnette
