// SPDX-License-Identifier: Apache-2.0
// One picture from a scene that a JSON file states in full (docs/rendering.md, "Composing a case"):
// input image, camera, pose, meshes, lens order and contour, environment, background.
//
// Lens frame of the file: origin at the BACK vertex, +z along the axis away from the face, +x to
// the wearer's left; converted here to that of optics/ray.h.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "base/camera.h"
#include "base/image.h"
#include "base/mesh.h"
#include "base/result.h"
#include "geometry/eyewear.h"
#include "render/compositor.h"
#include "render/environment.h"

namespace lorgnette {

// A case, read and checked: what Compositor::Create and Render take.
struct ComposeCase {
  std::string name;
  ImageRgbF input;
  Camera camera;
  Eigen::Isometry3d camera_from_head = Eigen::Isometry3d::Identity();
  TriangleMesh head;
  Eyewear eyewear;
  Environment environment = Environment::Constant({1, 1, 1});
  CompositorOptions options;  // quality settings of a still, and the case's background
};

// Paths in the file are relative to it. Both lenses pass Certify; the radii that the file states
// have to be those of the order to kCaseCurvatureTolerance_D.
Result<ComposeCase> ReadComposeCase(const std::string& path);
inline constexpr double kCaseCurvatureTolerance_D = 0.001;

struct ComposeOutput {
  ImageRgbF picture;  // linear light, the input's size
  ImageRgbaF hits;    // Compositor::HitMap
  RenderCounts counts;
  EffectPlan plan;
};
// Reads the case, renders it, and traces the hit map.
Result<ComposeOutput> Compose(const ComposeCase& scene, const EffectChoice& choice);

}  // namespace lorgnette
