// SPDX-License-Identifier: Apache-2.0
#include "optics/design.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "optics/base_curve.h"
#include "optics/gaze.h"
#include "optics/outline.h"
#include "optics/power_vector.h"
#include "optics/prism.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

constexpr double kLeastIndex = 1 + 1e-6;  // below it a power has no radius
constexpr double kMaxReducedPower = 0.5;  // tau F1 beyond which the design is near its pole
constexpr int kMaxThicknessSteps = 200;
constexpr double kThicknessTolerance_mm = 1e-12;
constexpr double kMaxThickness_mm = 60;
constexpr int kMaxAsphereSteps = 30;
constexpr double kAsphereTolerance_D = 1e-9;
constexpr double kFirstAsphere_per_mm3 = 1e-7;

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

Error NoSag(const char* face, double curvature, double index, double rim_mm) {
  const double reach = 1 / std::abs(curvature);
  return Error{
      fmt::format(
          "lens: the {} surface of {:+.2f} D at index {} has no real sag beyond {:.1f} mm "
          "from the optical centre and the outline reaches {:.1f} mm; possible: a lens up "
          "to {:.0f} mm across, a higher index or {}",
          face, (face[0] == 'f' ? 1 : -1) * 1000 * (index - 1) * curvature, index, reach, rim_mm,
          std::floor(2 * reach),
          face[0] == 'f' || curvature > 0 ? "a flatter base curve" : "a steeper base curve"),
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
  Diopters base;
  Eigen::Matrix2d power;
  GroundPrism prism;
  Outline outline;
  Surface front;  // unless it depends on the thickness
  double a4 = 0;  // of the aspheric front, mm^-3

  bool ToricFront() const {
    return order.toric_side == ToricSide::kFront && order.rx.cylinder != Diopters(0);
  }
  double Curvature() const { return base.per_mm() / (order.medium.index_d - 1); }

  Lens At(double thickness_mm) const {
    const double n = order.medium.index_d;
    Lens lens;
    lens.medium = order.medium;
    lens.center_thickness_mm = thickness_mm;
    lens.back_tilt_x = prism.tilt_x;
    lens.back_tilt_y = prism.tilt_y;
    if (ToricFront()) {
      SetToricFront(lens);
      return lens;
    }
    lens.front = order.aspheric_gaze_deg ? Surface(ConicSurface{Curvature(), 0, {a4}}) : front;
    const Eigen::Matrix2d front_D = 1000 * (n - 1) * lens.front.VertexCurvature();
    const Eigen::Matrix2d bend = order.power_form == PowerForm::kPaper
                                     ? PaperBackCurvature(front_D, power, thickness_mm, n)
                                     : BackCurvature(front_D, power, thickness_mm, n, prism);
    lens.back = ToricSurface(bend, order.generator, true);
    return lens;
  }
  double ReducedPower(double thickness_mm) const {
    return thickness_mm / 1000 / order.medium.index_d * base.value();
  }

 private:
  // Spherical back; the base curve is the front's flatter meridian, across the minus axis.
  void SetToricFront(Lens& lens) const {
    const double n = order.medium.index_d, tau = lens.center_thickness_mm / 1000 / n;
    const PowerVector p = PowerVectorOfLensFrame(power);
    const double weaker = p.mean - std::hypot(p.j0, p.j45);
    const double back = weaker - base.value() / (1 - tau * base.value());
    const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d arriving = power - back * identity;
    const Eigen::Matrix2d front_D = arriving * (identity + tau * arriving).inverse();
    lens.front = ToricSurface(front_D / (1000 * (n - 1)), order.generator, false);
    lens.back = SphereSurface{back / (1000 * (1 - n))};
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
        thickness_mm, plan.base.value(), plan.ReducedPower(thickness_mm), kMaxReducedPower));
  }
  Candidate candidate{plan.At(thickness_mm), {}};
  const auto edge = EdgeOver(candidate.lens, plan.outline);
  if (!edge) {
    const double n = plan.order.medium.index_d, rim = plan.outline.radius_mm();
    const double front = SteepestVertexCurvature(candidate.lens.front);
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

// Oblique astigmatism at the gaze of the order, of a lens with the mean power of this one.
Result<double> ObliqueAstigmatism(const Plan& plan, const Lens& lens) {
  Lens round = lens;
  round.back = SphereSurface{0.5 * lens.back.VertexCurvature().trace()};
  round.back_tilt_x = round.back_tilt_y = 0;
  const double n = plan.order.medium.index_d, gaze_deg = *plan.order.aspheric_gaze_deg;
  const GazeVergence gaze = EvaluateGaze(round, n, EyePose::OnAxis(round, plan.order.stop_mm),
                                         {RadiansFromDegrees(gaze_deg), 0});
  if (gaze.status != RayStatus::kOk) {
    return Failure(
        fmt::format("lens: no ray passes at {} degrees of eye rotation; possible: a "
                    "smaller gaze for the aspheric form",
                    gaze_deg));
  }
  return gaze.tangential_D - gaze.sagittal_D;
}

Result<Candidate> Solve(const Plan& plan) {
  return plan.order.center_thickness_mm ? WithGivenThickness(plan, *plan.order.center_thickness_mm)
                                        : SolveThickness(plan);
}

// Secant steps on the fourth-order term, the thickness solved anew each time.
Result<Candidate> SolveAsphere(Plan& plan) {
  LG_ASSIGN(Candidate candidate, Solve(plan));
  LG_ASSIGN(double error, ObliqueAstigmatism(plan, candidate.lens));
  double previous = 0, previous_error = error;
  plan.a4 = kFirstAsphere_per_mm3;
  for (int i = 0; i < kMaxAsphereSteps; ++i) {
    LG_ASSIGN(candidate, Solve(plan));
    LG_ASSIGN(error, ObliqueAstigmatism(plan, candidate.lens));
    if (std::abs(error) < kAsphereTolerance_D || error == previous_error) return candidate;
    const double slope = (error - previous_error) / (plan.a4 - previous);
    previous = plan.a4;
    previous_error = error;
    plan.a4 -= error / slope;
  }
  return Failure(
      fmt::format("lens: no aspheric front frees it of oblique astigmatism at {} degrees "
                  "({:+.3f} D are left); possible: another base curve",
                  *plan.order.aspheric_gaze_deg, error));
}

// What may not be combined, and the front that does not wait for the thickness.
Result<Surface> MakeFront(const LensOrder& order, Diopters base, const Outline& outline) {
  const double n = order.medium.index_d;
  const bool multifocal = order.segment || order.progressive;
  if (order.segment && order.progressive) {
    return UsageError("lens order: got a segment and a progressive front, want one of the two");
  }
  if (multifocal && !(order.rx.add > Diopters(0))) {
    return UsageError("lens order: a multifocal front without an addition, want an addition > 0");
  }
  const bool toric_front =
      order.toric_side == ToricSide::kFront && order.rx.cylinder != Diopters(0);
  if (int(multifocal) + int(toric_front) + int(order.aspheric_gaze_deg.has_value()) > 1) {
    return UsageError("lens order: want one of a toric, an aspheric and a multifocal front");
  }
  const bool prism = order.rx.prism_in.value() != 0 || order.rx.prism_up.value() != 0;
  if (order.power_form == PowerForm::kPaper && (prism || toric_front)) {
    return UsageError(
        "lens order: the paper's equation (1) knows no prism and no toric front; possible: the "
        "exact form");
  }
  if (toric_front && prism) {
    return UsageError("lens order: ground prism behind a toric front; possible: toric on the back");
  }
  if (order.segment) {
    if (order.segment->top_mm >= 0) {
      return UsageError(
          fmt::format("lens order: segment top: got {} mm, want below the optical "
                      "centre",
                      order.segment->top_mm));
    }
    return SegmentFront(*order.segment, order.eye, base, order.rx.add, n);
  }
  if (order.progressive) {
    return ProgressiveFront(*order.progressive, order.eye, base, order.rx.add, n,
                            outline.radius_mm());
  }
  return Surface(SphereSurface{base.per_mm() / (n - 1)});
}

Diopters BaseByRule(const LensOrder& order, double mean_power, double rim_radius_mm) {
  const double n = order.medium.index_d;
  Diopters base = VogelBaseCurve(Diopters(mean_power));
  if (order.base_rule == BaseCurveRule::kTscherning) {
    // Where the ellipse has no real form, Vogel's rule stays.
    if (const auto forms = Tscherning(Diopters(mean_power), n, order.stop_mm)) {
      base = forms->ostwalt;
    }
  }
  return std::min(base, SteepestBaseCurve(rim_radius_mm, n));
}

}  // namespace

Result<LensDesign> DesignLens(const LensOrder& order) {
  LG_RETURN_IF_ERROR(CheckOrder(order));
  const double n = order.medium.index_d;
  const PowerVector rx = PowerVectorOf({order.rx.sphere, order.rx.cylinder, order.rx.axis});
  const Outline outline = order.contour_mm.empty() ? Outline::Round(order.diameter_mm)
                                                   : Outline::FromPolygon(order.contour_mm);
  const Diopters base = order.base_curve.value_or(BaseByRule(order, rx.mean, outline.radius_mm()));
  if (!std::isfinite(base.value())) {
    return UsageError("lens order: base curve: not a finite number");
  }
  const Eigen::Vector2d prism =
      PrismInLensFrame(order.eye, order.rx.prism_in.value(), order.rx.prism_up.value());
  LG_ASSIGN(const Surface front, MakeFront(order, base, outline));
  Plan plan{order, base, LensFrameMatrix(rx), GrindPrism(prism, n), outline, front};

  LG_ASSIGN(Candidate found, order.aspheric_gaze_deg ? SolveAsphere(plan) : Solve(plan));
  LensDesign design;
  design.order = order;
  design.lens = found.lens;
  design.front_power = base;
  const Eigen::Matrix2d back_power = 1000 * (1 - n) * found.lens.back.VertexCurvature();
  const Eigen::Vector2d along = LensFrameDirection(order.rx.axis);
  const Eigen::Vector2d across(-along.y(), along.x());
  design.back_power_axis = Diopters(along.dot(back_power * along));
  design.back_power_across = Diopters(across.dot(back_power * across));
  design.min_edge_thickness_mm = found.edge.least_mm;
  design.max_edge_thickness_mm = found.edge.greatest_mm;
  design.mass_g = MassOver(found.lens, outline);
  design.min_blank_mm = 2 * outline.radius_mm() + kBlankAllowance_mm;
  return design;
}

}  // namespace lorgnette
