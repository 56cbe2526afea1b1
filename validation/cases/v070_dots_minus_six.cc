// SPDX-License-Identifier: Apache-2.0
#include "validation/dot_grid.h"

namespace lorgnette::validation {
namespace {

void RunV070(CaseRun& run) {
  LensOrder order;
  order.rx.sphere = Diopters(-6);
  order.medium.index_d = 1.6;
  CheckDotGrid(run, order);
}

}  // namespace

extern const Case kV070;
const Case kV070 = {"V070", "magnification",
                    "dots behind a -6 D lens, found in the compositor's picture",
                    "the program's exact rays (V061) against its own picture", RunV070};

}  // namespace lorgnette::validation
