// SPDX-License-Identifier: Apache-2.0
// Everything about the wearer and the eyewear that stays the same while the camera moves: meshes
// in head space, glass, light baked for the points of frame and face. Internal to render/.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "geometry/eyewear.h"
#include "render/compositor.h"
#include "render/embree_scene.h"
#include "render/environment.h"
#include "render/lens_solid.h"
#include "render/lighting.h"
#include "render/paper_shadow.h"

namespace lorgnette {

// The frame's parts as one mesh, demo lenses left out.
struct FrameSurface {
  TriangleMesh mesh;                       // head space, with normals and uvs
  std::vector<Eigen::Vector3f> normals;    // the mesh's, as every ray reads them
  std::vector<std::uint16_t> material_of;  // one a triangle
  std::vector<float> curvature;            // one a triangle: most turn of the normal, 1/mm
  std::vector<FrameMaterial> materials;    // one a part
  std::vector<bool> fades;                 // one a part: a temple
  // One a part: a closed surface whose triangles face outwards. No ray from beside it meets one
  // from behind first.
  std::vector<std::uint8_t> solid;
  std::vector<BlurredEnvironment> gloss;  // the environment under each Phong lobe in use
  std::vector<std::uint16_t> gloss_of;    // one a part
  // Under lobes of exponents 1, 4, 16, 64; where a texture chooses, of 256 and 1024 too.
  std::vector<BlurredEnvironment> lobes;
  // Radiance along a world direction under a lobe, between the two nearest of `lobes`.
  Eigen::Vector3f GlossAt(float exponent, const Eigen::Vector3f& direction) const;
  // The same under the part's own lobe, widened to `exponent`.
  Eigen::Vector3f OwnGlossAt(std::size_t part, float exponent,
                             const Eigen::Vector3f& direction) const;
  Eigen::Isometry3d frame_from_head = Eigen::Isometry3d::Identity();
  double fade_start_z = 0, fade_end_z = 0;  // frame coordinates: opaque before, gone after
};

// All that a camera ray can meet, in one list: face, occluder, frame.
struct VisibleMesh {
  std::vector<Eigen::Vector3f> vertices;            // head space, the face's first
  std::vector<Eigen::Vector3i> triangles;           // as above
  std::size_t first_occluder = 0, first_frame = 0;  // triangles

  // The triangle as EmbreeScene names it.
  SceneObject ObjectOf(std::size_t triangle) const {
    return triangle < first_occluder ? SceneObject::kFace
           : triangle < first_frame  ? SceneObject::kOccluder
                                     : SceneObject::kFrame;
  }
  std::size_t FirstOf(SceneObject object) const {
    return object == SceneObject::kFace       ? 0
           : object == SceneObject::kOccluder ? first_occluder
                                              : first_frame;
  }
};

struct HeadScene {
  static Result<HeadScene> Build(const Eyewear& eyewear, const TriangleMesh& face,
                                 const TriangleMesh& occluder, const Environment& environment,
                                 const CompositorOptions& options);

  CompositorOptions options;
  EmbreeScene scene;
  TriangleMesh face;
  std::vector<Eigen::Vector3f> face_vertices;
  std::vector<Eigen::Vector3f> face_normals;
  std::vector<Eigen::Vector3i> face_triangles;
  FrameSurface frame;
  VisibleMesh visible;
  std::vector<LensSolid> lenses;  // right, left
  std::vector<LensLook> looks;    // one a lens
  // Depth to which the frame reaches into the glass from the contour, mm; rays that stay farther
  // from the wall need no test against the frame.
  std::vector<double> rim_depth_mm;

  Environment environment;
  Eigen::Vector3f environment_mean{0, 0, 0};
  BrightestLight brightest;
  std::vector<Eigen::Vector3f> directions;  // of the baked light
  BlurredEnvironment cells;
  BakedIrradiance frame_light;
  std::optional<BakedShadow> baked_shadow;
  std::optional<PaperShadow> paper_shadow;
  std::optional<FaceLattice> gather_lattice;
};

}  // namespace lorgnette
