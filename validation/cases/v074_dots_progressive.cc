// SPDX-License-Identifier: Apache-2.0
#include "validation/dot_grid.h"

namespace lorgnette::validation {
namespace {

void RunV074(CaseRun& run) {
  LensOrder order;
  order.rx.sphere = Diopters(1);
  order.rx.add = Diopters(2);
  order.progressive = ProgressiveOrder{};
  order.medium.index_d = 1.6;
  CheckDotGrid(run, order, false);
}

}  // namespace

extern const Case kV074;
const Case kV074 = {"V074", "magnification",
                    "dots behind a progressive, +1.00 add 2.00, found in the compositor's picture",
                    "the program's exact rays (V061) against its own picture", RunV074};

}  // namespace lorgnette::validation
