// SPDX-License-Identifier: Apache-2.0
#include "validation/ground_truth.h"

namespace lorgnette::validation {
namespace {

void RunV089(CaseRun& run) { CheckGroundTruth(run, "plano_y0p0"); }

}  // namespace

extern const Case kV089;
const Case kV089 = {"V089",
                    "image",
                    "a path-traced wearer: plano_y0p0",
                    "Blender Cycles and exact rays; renders judged by their noise",
                    RunV089,
                    true};

}  // namespace lorgnette::validation
