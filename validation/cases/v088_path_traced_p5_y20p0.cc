// SPDX-License-Identifier: Apache-2.0
#include "validation/ground_truth.h"

namespace lorgnette::validation {
namespace {

void RunV088(CaseRun& run) { CheckGroundTruth(run, "p5_y20p0"); }

}  // namespace

extern const Case kV088;
const Case kV088 = {"V088",
                    "image",
                    "a path-traced wearer: p5_y20p0",
                    "Blender Cycles and exact rays; renders judged by their noise",
                    RunV088,
                    true};

}  // namespace lorgnette::validation
