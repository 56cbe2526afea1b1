// SPDX-License-Identifier: Apache-2.0
#include "optics/design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "optics/base_curve.h"
#include "optics/outline.h"
#include "optics/power_vector.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

constexpr double kLeastIndex = 1 + 1e-6;  // below it a power has no radius
constexpr double kMaxReducedPower = 0.5;  // tau F1 beyond which the design is near its pole
constexpr int kMaxThicknessSteps = 200;
constexpr double kThicknessTolerance_mm = 1e-12;
constexpr double kMaxThickness_mm = 60;

Status CheckOrder(const LensOrder& order) {
  const double numbers[] = {
      order.rx.sphere.value(),       order.rx.cylinder.value(),   order.rx.prism_in.value(),
      order.rx.prism_up.value(),     order.medium.index_d,        order.medium.density_g_cm3,
      order.min_center_thickness_mm, order.min_edge_thickness_mm, order.diameter_mm,
      order.vertex_distance_mm};
  for (const double number : numbers) {
    if (!std::isfinite(number)) return UsageError("lens order: a number is not finite");
  }
  if (!(order.medium.index_d > kLeastIndex)) {
    return UsageError(
        fmt::format("lens order: index: got {}, want more than 1, since a lens of "
                    "index 1 has no power at any curvature",
                    order.medium.index_d));
  }
  if (!(order.min_center_thickness_mm > 0)) {
    return UsageError(fmt::format("lens order: least centre thickness: got {} mm, want more than 0",
                                  order.min_center_thickness_mm));
  }
  if (order.min_edge_thickness_mm < 0) {
    return UsageError(fmt::format("lens order: least edge thickness: got {} mm, want 0 or more",
                                  order.min_edge_thickness_mm));
  }
  if (order.center_thickness_mm && !(*order.center_thickness_mm > 0)) {
    return UsageError(fmt::format("lens order: centre thickness: got {} mm, want more than 0",
                                  *order.center_thickness_mm));
  }
  if (order.contour_mm.empty() ? !(order.diameter_mm > 0) : order.contour_mm.size() < 3) {
    return UsageError("lens order: contour: want at least three points, or a diameter above 0");
  }
  for (const Eigen::Vector2d& p : order.contour_mm) {
    if (!p.allFinite()) return UsageError("lens order: contour: a point is not finite");
  }
  return {};
}

Eigen::Vector2d PrismInLensFrame(const LensOrder& order) {
  const double toward_nose = order.eye == Eye::kRight ? -1 : 1;
  return {toward_nose * order.rx.prism_in.value(), order.rx.prism_up.value()};
}

Error NoSag(const char* face, double curvature, double index, double rim_mm) {
  const double reach = 1 / std::abs(curvature);
  return Error{
      fmt::format("lens: the {} surface of {:+.2f} D at index {} has no real sag beyond {:.1f} mm "
                  "from the optical centre and the outline reaches {:.1f} mm; possible: a lens up "
                  "to {:.0f} mm across, a higher index or {}",
                  face, (face[0] == 'f' ? 1 : -1) * 1000 * (index - 1) * curvature, index, reach,
                  rim_mm, std::floor(2 * reach),
                  face[0] == 'f' ? "a flatter base curve" : "a steeper base curve"),
      ErrorKind::kFailure};
}

double SteepestVertexCurvature(const Surface& surface) {
  const Eigen::Matrix2d k = surface.VertexCurvature();
  const double mean = 0.5 * k.trace(), half_range = std::hypot(0.5 * (k(0, 0) - k(1, 1)), k(0, 1));
  return mean + std::copysign(half_range, mean);
}

// Everything about the lens but its thickness.
struct Plan {
  const LensOrder& order;
  Diopters front;
  Eigen::Matrix2d power;
  GroundPrism prism;
  Outline outline;

  Lens At(double thickness_mm) const {
    const double n = order.medium.index_d;
    Lens lens;
    lens.medium = order.medium;
    lens.center_thickness_mm = thickness_mm;
    lens.front = SphereSurface{front.per_mm() / (n - 1)};
    lens.back_tilt_x = prism.tilt_x;
    lens.back_tilt_y = prism.tilt_y;
    lens.back = ToricSurface(
        BackCurvature(front.value() * Eigen::Matrix2d::Identity(), power, thickness_mm, n, prism),
        order.generator, true);
    return lens;
  }
  double ReducedPower(double thickness_mm) const {
    return thickness_mm / 1000 / order.medium.index_d * front.value();
  }
};

// The lens of a given thickness and its edge, or why there is none.
struct Candidate {
  Lens lens;
  EdgeThickness edge;
};
Result<Candidate> Try(const Plan& plan, double thickness_mm) {
  if (plan.ReducedPower(thickness_mm) > kMaxReducedPower) {
    return Failure(fmt::format(
        "lens: {:.1f} mm thick with a front of {:+.2f} D, tau F1 is {:.2f} and must stay below "
        "{}; possible: a flatter base curve or a smaller outline",
        thickness_mm, plan.front.value(), plan.ReducedPower(thickness_mm), kMaxReducedPower));
  }
  Candidate candidate{plan.At(thickness_mm), {}};
  const auto edge = EdgeOver(candidate.lens, plan.outline);
  if (!edge) {
    const double n = plan.order.medium.index_d, rim = plan.outline.radius_mm();
    const double front = plan.front.per_mm() / (n - 1);
    if (std::abs(front) * rim >= 1) return tl::unexpected(NoSag("front", front, n, rim));
    return tl::unexpected(NoSag("back", SteepestVertexCurvature(candidate.lens.back), n, rim));
  }
  candidate.edge = *edge;
  return candidate;
}

// Least thickness that keeps the minima. F2 depends on it through tau, weakly: the shortfall is
// simply added until nothing is missing.
Result<Candidate> SolveThickness(const Plan& plan) {
  const LensOrder& order = plan.order;
  double thickness = order.min_center_thickness_mm;
  for (int i = 0; i < kMaxThicknessSteps; ++i) {
    LG_ASSIGN(Candidate candidate, Try(plan, thickness));
    const double missing =
        std::max(order.min_edge_thickness_mm - candidate.edge.least_mm,
                 std::min(order.min_edge_thickness_mm, order.min_center_thickness_mm) -
                     candidate.edge.least_inside_mm);
    const double next = std::max(thickness + missing, order.min_center_thickness_mm);
    if (std::abs(next - thickness) < kThicknessTolerance_mm) return candidate;
    if (next > kMaxThickness_mm) break;
    thickness = next;
  }
  return Failure(fmt::format(
      "lens: no centre thickness up to {} mm gives an edge of {} mm; possible: a smaller outline, "
      "a higher index or a flatter base curve",
      kMaxThickness_mm, order.min_edge_thickness_mm));
}

Result<Candidate> WithGivenThickness(const Plan& plan, double thickness_mm) {
  LG_ASSIGN(Candidate candidate, Try(plan, thickness_mm));
  if (candidate.edge.least_inside_mm >= 0) return candidate;
  const Result<Candidate> possible = SolveThickness(plan);
  const std::string hint =
      possible ? fmt::format("{:.2f} mm at the centre for the least edge of {} mm",
                             possible->lens.center_thickness_mm, plan.order.min_edge_thickness_mm)
               : std::string("a smaller outline");
  return Failure(
      fmt::format("lens: with {} mm at the centre the surfaces cross, the edge would be "
                  "{:.2f} mm; possible: {}",
                  thickness_mm, candidate.edge.least_inside_mm, hint));
}

}  // namespace

Result<LensDesign> DesignLens(const LensOrder& order) {
  LG_RETURN_IF_ERROR(CheckOrder(order));
  const double n = order.medium.index_d;
  const PowerVector rx = PowerVectorOf({order.rx.sphere, order.rx.cylinder, order.rx.axis});
  Plan plan{order,
            {},
            LensFrameMatrix(rx),
            GrindPrism(PrismInLensFrame(order), n),
            order.contour_mm.empty() ? Outline::Round(order.diameter_mm)
                                     : Outline::FromPolygon(order.contour_mm)};
  plan.front = order.base_curve.value_or(
      std::min(VogelBaseCurve(Diopters(rx.mean)), SteepestBaseCurve(plan.outline.radius_mm(), n)));
  if (!std::isfinite(plan.front.value())) {
    return UsageError("lens order: base curve: not a finite number");
  }

  LG_ASSIGN(Candidate found, order.center_thickness_mm
                                 ? WithGivenThickness(plan, *order.center_thickness_mm)
                                 : SolveThickness(plan));
  LensDesign design;
  design.order = order;
  design.lens = found.lens;
  design.front_power = plan.front;
  const Eigen::Matrix2d back_power = 1000 * (1 - n) * found.lens.back.VertexCurvature();
  const Eigen::Vector2d along = LensFrameDirection(order.rx.axis);
  const Eigen::Vector2d across(-along.y(), along.x());
  design.back_power_axis = Diopters(along.dot(back_power * along));
  design.back_power_across = Diopters(across.dot(back_power * across));
  design.min_edge_thickness_mm = found.edge.least_mm;
  design.max_edge_thickness_mm = found.edge.greatest_mm;
  design.mass_g = MassOver(found.lens, plan.outline);
  return design;
}

}  // namespace lorgnette
