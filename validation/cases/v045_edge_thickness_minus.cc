// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "validation/case.h"
#include "validation/made_lens.h"

namespace lorgnette::validation {
namespace {

void RunV045(CaseRun& run) {
  const double diameter[] = {50, 60, 70}, edge[] = {4.747977, 6.260804, 8.123445};
  for (int i = 0; i < 3; ++i) {
    const auto lens = RoundDesign(-6, 1.6, 2, diameter[i], 1.5);
    run.Rounded("-6, diameter " + std::to_string(int(diameter[i])), "mm", edge[i], 6,
                lens ? lens->max_edge_thickness_mm : 0);
  }
  const auto strong = RoundDesign(-10, 1.74, 1, 65, 1.5);
  run.Rounded("-10, n 1.74, diameter 65", "mm", 9.158094, 6,
              strong ? strong->max_edge_thickness_mm : 0);
  const auto sixty = RoundDesign(-6, 1.6, 2, 60, 1.5);
  run.Rounded("mass, diameter 60", "g", 14.098, 3, sixty ? sixty->mass_g : 0);
}

}  // namespace

extern const Case kV045;
const Case kV045 = {"V045", "design", "C5: edge thickness and mass of minus lenses",
                    "derived with 30 digits", RunV045};

}  // namespace lorgnette::validation
