// SPDX-License-Identifier: Apache-2.0
#include "validation/ground_truth.h"

namespace lorgnette::validation {
namespace {

void RunV087(CaseRun& run) { CheckGroundTruth(run, "p5_y0p0"); }

}  // namespace

extern const Case kV087;
const Case kV087 = {"V087",
                    "image",
                    "a path-traced wearer: p5_y0p0",
                    "Blender Cycles and exact rays; renders judged by their noise",
                    RunV087,
                    true};

}  // namespace lorgnette::validation
