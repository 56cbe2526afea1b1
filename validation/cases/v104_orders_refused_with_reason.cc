// SPDX-License-Identifier: Apache-2.0
#include "optics/design.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

LensOrder Order(double sphere, double index, double base, double diameter) {
  LensOrder order;
  order.rx.sphere = Diopters(sphere);
  order.medium.index_d = index;
  order.base_curve = Diopters(base);
  order.diameter_mm = diameter;
  return order;
}

void RunV104(CaseRun& run) {
  const auto refuses = [&](const char* what, const LensOrder& order, const char* word) {
    const auto design = DesignLens(order);
    const bool named = !design && design.error().message.find(word) != std::string::npos;
    run.Exact(std::string(what) + ": refused, and why", "1", 1, named ? 1 : 0);
  };
  const auto makes = [&](const char* what, const LensOrder& order) {
    run.Exact(std::string(what) + ": made", "1", 1, DesignLens(order) ? 1 : 0);
  };
  // -20 D, n 1.5, F1 +0.5: the back has 24.4 mm of radius and no sag beyond.
  refuses("-20 D over 60 mm", Order(-20, 1.5, 0.5, 60), "possible");
  makes("-20 D over 40 mm", Order(-20, 1.5, 0.5, 40));
  LensOrder knife = Order(6, 1.6, 9, 60);
  knife.center_thickness_mm = 1;
  refuses("+6 D of 1 mm: the surfaces cross", knife, "cross");
  knife.center_thickness_mm = 8;
  makes("+6 D of 8 mm", knife);
  LensOrder pole = Order(5, 1.6, 16, 20);
  pole.center_thickness_mm = 60;
  refuses("tau F1 of 0.6", pole, "tau F1");
  pole.center_thickness_mm = 30;
  makes("tau F1 of 0.3", pole);
  refuses("glass of index 1", Order(-3, 1, 4, 50), "index");
}

}  // namespace

extern const Case kV104;
const Case kV104 = {"V104", "hard", "orders that cannot be made are refused with their reason",
                    "optics reference section 13, rows 7 to 10", RunV104};

}  // namespace lorgnette::validation
