// SPDX-License-Identifier: Apache-2.0
#include "validation/ground_truth.h"

namespace lorgnette::validation {
namespace {

void RunV085(CaseRun& run) { CheckGroundTruth(run, "m6_y0p0"); }

}  // namespace

extern const Case kV085;
const Case kV085 = {"V085",
                    "image",
                    "a path-traced wearer: m6_y0p0",
                    "Blender Cycles and exact rays; renders judged by their noise",
                    RunV085,
                    true};

}  // namespace lorgnette::validation
