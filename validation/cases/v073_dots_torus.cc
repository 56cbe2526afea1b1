// SPDX-License-Identifier: Apache-2.0
#include "validation/dot_grid.h"

namespace lorgnette::validation {
namespace {

void RunV073(CaseRun& run) {
  LensOrder order;
  order.rx.sphere = Diopters(-4);
  order.rx.cylinder = Diopters(-2.5);
  order.rx.axis = AxisDegrees(30);
  order.medium.index_d = 1.6;
  CheckDotGrid(run, order);
}

}  // namespace

extern const Case kV073;
const Case kV073 = {"V073", "magnification",
                    "dots behind -4.00 -2.50 x 30, found in the compositor's picture",
                    "the program's exact rays (V061) against its own picture", RunV073};

}  // namespace lorgnette::validation
