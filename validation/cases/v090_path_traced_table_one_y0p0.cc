// SPDX-License-Identifier: Apache-2.0
#include "validation/ground_truth.h"

namespace lorgnette::validation {
namespace {

void RunV090(CaseRun& run) { CheckGroundTruth(run, "tableI_y0p0"); }

}  // namespace

extern const Case kV090;
const Case kV090 = {"V090",
                    "image",
                    "a path-traced wearer: tableI_y0p0",
                    "Blender Cycles and exact rays; renders judged by their noise",
                    RunV090,
                    true};

}  // namespace lorgnette::validation
