// SPDX-License-Identifier: Apache-2.0
// A wearer to render in studies and cases: a head of formulas with shipped eyewear on it, before a
// camera, in light that has a lamp; or whatever a composed case states.
#pragma once

#include <string>

#include "base/camera.h"
#include "base/result.h"
#include "geometry/eyewear.h"
#include "optics/design.h"
#include "render/compositor.h"
#include "render/environment.h"

namespace lorgnette::validation {

struct WornScene {
  std::string name;
  Eyewear eyewear;
  TriangleMesh face, occluder;
  Environment environment = Environment::Constant({1, 1, 1});
  ImageRgbF input;  // linear light
  Camera camera;
  Eigen::Isometry3d camera_from_head = Eigen::Isometry3d::Identity();
  CompositorOptions options;  // what belongs to the scene: background, environment
};

// Both lenses from one order, in a shipped frame (geometry/frame_io.h), 1280 x 720 pixels, about
// 2.5 of them a mm. The input picture has skin, eyes and brows with fine detail, and a background.
Result<WornScene> MadeScene(const LensOrder& order, const std::string& frame = "panto");
// A file that `lorgnette compose` takes.
Result<WornScene> SceneFromCase(const std::string& path);

// The same picture at 1/factor of its size, by means over factor x factor pixels.
ImageRgbF Shrunk(const ImageRgbF& image, int factor);
Camera Shrunk(const Camera& camera, int factor);
// Back to the size of `like`, bilinear.
ImageRgbF Grown(const ImageRgbF& image, int factor, const ImageRgbF& like);

}  // namespace lorgnette::validation
