// SPDX-License-Identifier: Apache-2.0
#include "geometry/assemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/frame_adjust.h"
#include "optics/base_curve.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

Error About(Eye eye, Error error) {
  error.message = (eye == Eye::kRight ? "right lens: " : "left lens: ") + error.message;
  return error;
}

// Along head z from the cornea to the back surface; nullopt when the line misses it.
std::optional<double> VertexDistance(const CutLens& lens, const Eigen::Isometry3d& head_from_frame,
                                     const Eigen::Vector3d& pupil) {
  const Eigen::Isometry3d lens_from_head = (head_from_frame * lens.frame_from_lens).inverse();
  const Ray sight{lens_from_head * pupil, lens_from_head.linear() * Eigen::Vector3d::UnitZ()};
  const auto hit = IntersectBack(lens.lens.lens(), sight);
  return hit ? std::optional(hit->distance) : std::nullopt;
}

Result<CutLens> MakeLens(const LensOrder& order, const LensOpening& opening,
                         const Eigen::Vector2d& centre, const CutOptions& cut) {
  LG_ASSIGN(LensDesign design, DesignLens(order));
  LG_ASSIGN(const CertifiedLens certified, Certify(std::move(design)));
  return CutAndMount(certified, opening, centre, cut);
}

struct LensPair {
  CutLens right, left;
  double misfit_mm() const { return std::max(right.mount_misfit_mm, left.mount_misfit_mm); }
};

// The two lenses of a fit, with the base curves of the options or, where these leave them open,
// such that the bevels follow the rims.
class PairMaker {
 public:
  PairMaker(const Fit& fit, const Prescription& prescription, const Eigen::Vector3d& pupil_right,
            const Eigen::Vector3d& pupil_left, const EyewearOptions& options)
      : fit_(fit), cut_(options.cut) {
    if (!cut_.edge) cut_.edge = EdgeFor(fit.frame.mount);
    orders_[0] = OrderLens(Eye::kRight, fit, prescription, pupil_right, options, centres_[0]);
    orders_[1] = OrderLens(Eye::kLeft, fit, prescription, pupil_left, options, centres_[1]);
  }

  Result<LensPair> Make() const {
    LG_ASSIGN(LensPair by_rule, MakeOf(orders_));
    if (cut_.edge != EdgeForm::kBevel || by_rule.misfit_mm() <= kMisfitNote_mm) return by_rule;
    if (orders_[0].base_curve || orders_[1].base_curve) return by_rule;
    LensPair best = by_rule;
    const double gap_D = (by_rule.right.rim_steeper_D + by_rule.left.rim_steeper_D) / 2;
    const int steps = std::min(kMostBaseSteps, int(std::abs(gap_D) / kBaseStep_D));
    bool changed = false;
    for (int k = 1; k <= steps && best.misfit_mm() > kMisfitNote_mm; ++k) {
      const std::optional<Orders> orders = Changed(by_rule, std::copysign(k * kBaseStep_D, gap_D));
      if (!orders) break;
      auto tried = MakeOf(*orders);
      if (!tried || tried->misfit_mm() >= best.misfit_mm()) break;
      best = *std::move(tried);
      changed = true;
    }
    if (!changed) return by_rule;
    for (const auto& [lens, from] :
         {std::pair(&best.right, &by_rule.right), std::pair(&best.left, &by_rule.left)}) {
      lens->notes.insert(
          lens->notes.begin(),
          fmt::format("front of {:.2f} D in place of the rule's {:.2f}: the bevel is {:.1f} mm off "
                      "the groove, not {:.1f}",
                      lens->lens.design().front_power.value(),
                      from->lens.design().front_power.value(), lens->mount_misfit_mm,
                      from->mount_misfit_mm));
    }
    return best;
  }

 private:
  using Orders = std::array<LensOrder, 2>;

  Result<LensPair> MakeOf(const Orders& orders) const {
    auto right = MakeLens(orders[0], fit_.frame.right, centres_[0], cut_);
    if (!right) return tl::unexpected(About(Eye::kRight, right.error()));
    auto left = MakeLens(orders[1], fit_.frame.left, centres_[1], cut_);
    if (!left) return tl::unexpected(About(Eye::kLeft, left.error()));
    return LensPair{*std::move(right), *std::move(left)};
  }

  // The orders with other fronts than the pair has; nullopt where one would be too flat.
  std::optional<Orders> Changed(const LensPair& pair, double change_D) const {
    Orders orders = orders_;
    orders[0].base_curve = pair.right.lens.design().front_power + Diopters(change_D);
    orders[1].base_curve = pair.left.lens.design().front_power + Diopters(change_D);
    for (const LensOrder& order : orders) {
      if (order.base_curve->value() < kFlattestRuleCurve_D) return std::nullopt;
    }
    return orders;
  }

  const Fit& fit_;
  CutOptions cut_;
  Orders orders_;
  Eigen::Vector2d centres_[2];
};

}  // namespace

LensOrder OrderLens(Eye eye, const Fit& fit, const Prescription& prescription,
                    const Eigen::Vector3d& pupil, const EyewearOptions& options,
                    Eigen::Vector2d& optical_centre) {
  const bool right = eye == Eye::kRight;
  const LensOpening& opening = right ? fit.frame.right : fit.frame.left;
  optical_centre = PupilInOpening(opening, fit.head_from_frame, pupil);
  optical_centre.y() -= options.drop_mm_per_degree * fit.wearing.pantoscopic_tilt_deg;
  LensOrder order;
  order.eye = eye;
  order.rx = right ? prescription.right : prescription.left;
  order.medium = options.medium;
  order.base_curve = options.base_curves[right ? 0 : 1];
  order.center_thickness_mm = options.center_thickness_mm;
  order.min_center_thickness_mm = options.min_center_thickness_mm;
  order.min_edge_thickness_mm = options.min_edge_thickness_mm;
  order.contour_mm = ContourInLensFrame(opening.contour_mm, optical_centre);
  order.vertex_distance_mm =
      right ? fit.wearing.vertex_distance_right_mm : fit.wearing.vertex_distance_left_mm;
  return order;
}

Result<Eyewear> MakeEyewear(const Fit& fit, const Prescription& prescription,
                            const Eigen::Vector3d& pupil_right, const Eigen::Vector3d& pupil_left,
                            const EyewearOptions& options) {
  LG_ASSIGN(LensPair pair, PairMaker(fit, prescription, pupil_right, pupil_left, options).Make());
  Eyewear eyewear{fit.frame, std::move(pair.right), std::move(pair.left), fit.head_from_frame,
                  fit.wearing};
  WearingPosition& wearing = eyewear.wearing;
  for (const auto& [lens, side] :
       {std::pair(&eyewear.right, "right lens: "), std::pair(&eyewear.left, "left lens: ")}) {
    for (const std::string& note : lens->notes) wearing.notes.push_back(side + note);
  }
  if (const auto d = VertexDistance(eyewear.right, fit.head_from_frame, pupil_right)) {
    wearing.vertex_distance_right_mm = *d;
  }
  if (const auto d = VertexDistance(eyewear.left, fit.head_from_frame, pupil_left)) {
    wearing.vertex_distance_left_mm = *d;
  }
  return eyewear;
}

Result<FittedEyewear> FitEyewear(const FrameModel& frame, const TriangleMesh& face,
                                 const Eigen::Vector3d& pupil_right,
                                 const Eigen::Vector3d& pupil_left,
                                 const Prescription& prescription, const FitOptions& fit_options,
                                 const EyewearOptions& options) {
  LG_ASSIGN(const Fit first, PlaceOnFace(frame, face, pupil_right, pupil_left, fit_options));
  LG_ASSIGN(const Eyewear tried,
            MakeEyewear(first, prescription, pupil_right, pupil_left, options));
  // How much nearer to the eyes the lenses are than was assumed.
  const double deeper =
      (first.wearing.vertex_distance_right_mm + first.wearing.vertex_distance_left_mm -
       tried.wearing.vertex_distance_right_mm - tried.wearing.vertex_distance_left_mm) /
      2;
  FitOptions again = fit_options;
  again.lens_depth_mm += deeper;
  LG_ASSIGN(Fit fit, PlaceOnFace(frame, face, pupil_right, pupil_left, again));
  LG_ASSIGN(Eyewear eyewear, MakeEyewear(fit, prescription, pupil_right, pupil_left, options));
  NoteVertexDistance(fit_options, eyewear.wearing);
  return FittedEyewear{std::move(fit), std::move(eyewear)};
}

}  // namespace lorgnette
