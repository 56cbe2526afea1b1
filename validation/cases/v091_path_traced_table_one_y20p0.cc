// SPDX-License-Identifier: Apache-2.0
#include "validation/ground_truth.h"

namespace lorgnette::validation {
namespace {

void RunV091(CaseRun& run) { CheckGroundTruth(run, "tableI_y20p0"); }

}  // namespace

extern const Case kV091;
const Case kV091 = {"V091",
                    "image",
                    "a path-traced wearer: tableI_y20p0",
                    "Blender Cycles and exact rays; renders judged by their noise",
                    RunV091,
                    true};

}  // namespace lorgnette::validation
