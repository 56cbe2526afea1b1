// SPDX-License-Identifier: Apache-2.0
#include "validation/ground_truth.h"

namespace lorgnette::validation {
namespace {

void RunV093(CaseRun& run) { CheckGroundTruth(run, "own_p4", OwnGroundTruthFolder()); }

}  // namespace

extern const Case kV093;
const Case kV093 = {
    "V093",
    "image",
    "a wearer path-traced by scripts/make-groundtruth: +4 D, head turned and lowered",
    "Blender Cycles, and exact rays of scripts/groundtruth_rays.py",
    RunV093,
    true};

}  // namespace lorgnette::validation
