// SPDX-License-Identifier: Apache-2.0
// Path-traced pictures with their scenes, where a set of them lies on this machine, and how close
// the compositor comes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/result.h"
#include "render/compose.h"
#include "validation/case.h"

namespace lorgnette::validation {

// $LORGNETTE_GROUNDTRUTH, else shared/data/groundtruth beside the folder this was built from.
std::string GroundTruthFolder();
// Where scripts/make-groundtruth leaves the project's own set.
std::string OwnGroundTruthFolder();

// One case of a set: the scene, and what was traced inside a crop of the picture.
struct GroundTruth {
  ComposeCase scene;
  int x0 = 0, y0 = 0;  // of the crop
  ImageRgbF truth;     // the paper's light model: frame, refraction, reflection, no caustics
  ImageRgbF frame_only;
  ImageRgbaF hits;  // head-space mm and HitCode of the ray through each pixel's centre
  double noise_lens = 0, noise_skin = 0;  // standard error of `truth`, linear, a pixel
  double noise_input = 0;                 // of the input picture
};
Result<GroundTruth> ReadGroundTruth(const std::string& case_file);

// Region of the picture.
enum class Region { kEyes, kLens, kShadow };
struct RegionScore {
  long pixels = 0;
  double psnr_db = 0;       // display-encoded
  double mean_square = 0;   // of the linear difference
  double noise_square = 0;  // what the noise of truth and input alone would give
  double bias = 0;          // mean linear difference over the mean of the truth
};
RegionScore ScoreRegion(const GroundTruth& truth, const ImageRgbF& picture, Region region);

// A case of the validation suite on one set: renders, compares by noise, and shows that leaving an
// effect out scores worse. Skips where the set is absent.
void CheckGroundTruth(CaseRun& run, const std::string& name,
                      const std::string& folder = GroundTruthFolder());

}  // namespace lorgnette::validation
