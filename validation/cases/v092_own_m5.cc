// SPDX-License-Identifier: Apache-2.0
#include "validation/ground_truth.h"

namespace lorgnette::validation {
namespace {

void RunV092(CaseRun& run) { CheckGroundTruth(run, "own_m5", OwnGroundTruthFolder()); }

}  // namespace

extern const Case kV092;
const Case kV092 = {"V092",
                    "image",
                    "a wearer path-traced by scripts/make-groundtruth: -5 D, seen from the front",
                    "Blender Cycles, and exact rays of scripts/groundtruth_rays.py",
                    RunV092,
                    true};

}  // namespace lorgnette::validation
