// SPDX-License-Identifier: Apache-2.0
#include "validation/dot_grid.h"

namespace lorgnette::validation {
namespace {

void RunV072(CaseRun& run) {
  LensOrder order;
  order.medium.index_d = 1.5;
  CheckDotGrid(run, order);
}

}  // namespace

extern const Case kV072;
const Case kV072 = {"V072", "magnification",
                    "dots behind a plano lens, found in the compositor's picture",
                    "the program's exact rays (V061) against its own picture", RunV072};

}  // namespace lorgnette::validation
