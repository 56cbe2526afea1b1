// SPDX-License-Identifier: Apache-2.0
#include "optics/prism_design.h"

#include <cmath>

#include "optics/prism.h"

namespace lorgnette {
namespace {

constexpr int kMaxDesignSteps = 40;
constexpr double kSettled_mm = 1e-10;
constexpr int kRoundPoints = 720;  // a 60 mm circle to 0.3 micrometres

std::vector<Eigen::Vector2d> ContourOf(const LensOrder& order) {
  if (!order.contour_mm.empty()) return order.contour_mm;
  std::vector<Eigen::Vector2d> circle;
  for (int i = 0; i < kRoundPoints; ++i) {
    const double phi = 2 * kPi * i / kRoundPoints;
    circle.emplace_back(0.5 * order.diameter_mm * Eigen::Vector2d(std::cos(phi), std::sin(phi)));
  }
  return circle;
}

}  // namespace

Result<PrismDesign> DesignWithPrism(const LensOrder& order, double max_decentration_mm) {
  const Eigen::Vector2d prism =
      PrismInLensFrame(order.eye, order.rx.prism_in.value(), order.rx.prism_up.value());
  PrismDesign made;
  const auto grind = [&](const std::string& why) -> Result<PrismDesign> {
    LG_ASSIGN(made.design, DesignLens(order));
    made.reference_point_mm.setZero();
    made.why_ground = why;
    return made;
  };
  if (prism.isZero(0)) return grind("");

  const std::vector<Eigen::Vector2d> contour = ContourOf(order);
  LensOrder centred = order;
  centred.rx.prism_in = centred.rx.prism_up = PrismDiopters(0);
  for (int i = 0; i < kMaxDesignSteps; ++i) {
    centred.contour_mm = contour;
    for (Eigen::Vector2d& p : centred.contour_mm) p += made.reference_point_mm;
    auto design = DesignLens(centred);
    if (!design) return grind(design.error().message);
    const auto point = DecenterForPrism(design->lens, prism, max_decentration_mm);
    if (!point) return grind(point.error().message);
    const double moved = (*point - made.reference_point_mm).norm();
    made.reference_point_mm = *point;
    if (moved < kSettled_mm) {
      made.design = std::move(*design);
      made.decentred = true;
      return made;
    }
    // Keep the first lens' front: the rule looks at the rim, and would follow the point by steps.
    if (!centred.base_curve) centred.base_curve = design->front_power;
  }
  return grind("decentration does not settle");
}

}  // namespace lorgnette
