// SPDX-License-Identifier: Apache-2.0
// The studies of `lorgnette cost`, each on a lens and a scene of choice.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "optics/design.h"
#include "validation/cost/camera_lens.h"
#include "validation/cost/scene.h"
#include "validation/cost/stopwatch.h"
#include "validation/cost/study.h"

namespace lorgnette::validation {

struct CostOptions {
  std::vector<std::string> studies;  // of StudyNames(); empty: all
  LensView view;
  int most_triangles = 1 << 20;
  // Rays through lenses in one frame: the view's own lens, both eyes, 2 x 2 samples a pixel.
  double rays_per_frame = 0;  // 0: counted from the view
  StopwatchOptions stopwatch;
  std::string frame = "panto";  // of the made scene (scene.h)
  std::string scene_case;       // a file for `lorgnette compose` in its place; its own lenses
};

std::vector<std::string> StudyNames();

// Everything for one design.
Result<CostReport> RunCost(const LensDesign& design, const CostOptions& options);

// One lens: rays from the camera to the face, by every method of lens_methods.h.
Result<CostStudy> LensStudy(const Lens& lens, const CostOptions& options);

// The formulas of design: power, tilt, magnification; appends three studies.
Status DesignStudies(const LensDesign& design, const CostOptions& options,
                     std::vector<CostStudy>& studies);

// Shadow of the frame on the face, by rays at every pixel, baked, and by harmonics; one thread.
Result<CostStudy> ShadingStudy(const WornScene& scene, const CostOptions& options);
// Whole pictures: samples, effects, resolution, and the presets of render/quality.h.
Result<CostStudy> PictureStudy(const WornScene& scene, const CostOptions& options);

}  // namespace lorgnette::validation
