// SPDX-License-Identifier: Apache-2.0
#include "validation/ground_truth.h"

namespace lorgnette::validation {
namespace {

void RunV086(CaseRun& run) { CheckGroundTruth(run, "m6_y20p0"); }

}  // namespace

extern const Case kV086;
const Case kV086 = {"V086",
                    "image",
                    "a path-traced wearer: m6_y20p0",
                    "Blender Cycles and exact rays; renders judged by their noise",
                    RunV086,
                    true};

}  // namespace lorgnette::validation
