// SPDX-License-Identifier: Apache-2.0
#include "validation/dot_grid.h"

namespace lorgnette::validation {
namespace {

void RunV071(CaseRun& run) {
  LensOrder order;
  order.rx.sphere = Diopters(5);
  order.medium.index_d = 1.5;
  CheckDotGrid(run, order);
}

}  // namespace

extern const Case kV071;
const Case kV071 = {"V071", "magnification",
                    "dots behind a +5 D lens, found in the compositor's picture",
                    "the program's exact rays (V061) against its own picture", RunV071};

}  // namespace lorgnette::validation
