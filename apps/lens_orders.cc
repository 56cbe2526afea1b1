// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_orders.h"

#include <fmt/format.h>

#include <cmath>

#include "apps/lens_surfaces.h"
#include "base/atomic_file.h"
#include "geometry/cut_lens.h"
#include "geometry/frame_io.h"
#include "optics/base_curve.h"

namespace lorgnette {
namespace {

constexpr double kRoundWidth_mm = 22, kFlatTopWidth_mm = 28;

void SetMultifocal(const LensOptions& o, LensOrder& order) {
  if (o.multifocal == "none") return;
  if (o.multifocal == "progressive" || o.multifocal == "soft") {
    ProgressiveOrder& front = order.progressive.emplace();
    front.design = o.multifocal == "soft" ? ProgressiveDesign::kSoft : ProgressiveDesign::kHard;
    front.start_mm = o.corridor_start_mm;
    front.corridor_mm = o.corridor_mm;
    front.inset_mm = o.near_inset_mm;
    return;
  }
  SegmentOrder& segment = order.segment.emplace();
  segment.shape = o.multifocal == "round"      ? SegmentShape::kRound
                  : o.multifocal == "flat-top" ? SegmentShape::kFlatTop
                                               : SegmentShape::kExecutive;
  segment.width_mm = o.segment_width_mm.value_or(
      segment.shape == SegmentShape::kRound ? kRoundWidth_mm : kFlatTopWidth_mm);
  segment.top_mm = o.segment_top_mm;
  segment.inset_mm = o.segment_inset_mm;
}

// The chart's base curve, when it is asked for and no other is given. Needs order.rx and medium.
Status ApplyChart(const LensOptions& options, LensOrder& order) {
  if (options.base_rule != "chart") {
    if (options.chart.empty()) return {};
    return UsageError("--chart: got a chart without --base-rule chart, want both");
  }
  if (order.base_curve) return {};
  const std::string path =
      options.chart.empty() ? DataDirectory() + "/base_curves.json" : options.chart;
  LG_ASSIGN(const std::string text, ReadFile(path));
  LG_ASSIGN(const BaseCurveChart chart, ParseBaseCurveChart(text, path));
  const Diopters equivalent = order.rx.sphere + 0.5 * order.rx.cylinder;
  LG_ASSIGN(order.base_curve, chart.Choose(order.medium.name, order.medium.index_d, equivalent));
  return {};
}

bool IsCompensated(const LensOptions& o) {
  return o.pantoscopic_deg != 0 || o.face_form_deg != 0 ||
         (o.refraction_vertex_mm && o.vertex_distance_mm &&
          *o.refraction_vertex_mm != *o.vertex_distance_mm);
}

}  // namespace

Result<LensOrder> OrderFromPrescription(const EyePrescription& rx, Eye eye, const LensOptions& o) {
  LG_RETURN_IF_ERROR(CheckMaking(o));
  LensOrder order;
  order.eye = eye;
  order.rx = rx;
  LG_ASSIGN(const MediumEntry medium, MediumOf(o));
  order.medium = medium.medium;
  order.min_center_thickness_mm = o.min_center_mm.value_or(medium.min_center_mm);
  order.min_edge_thickness_mm = o.min_edge_mm.value_or(medium.min_edge_mm);
  if (o.base_D) order.base_curve = Diopters(*o.base_D);
  order.center_thickness_mm = o.center_thickness_mm;
  order.diameter_mm = o.diameter_mm;
  order.vertex_distance_mm =
      o.vertex_distance_mm.value_or(o.refraction_vertex_mm.value_or(kDefaultVertex_mm));
  order.generator =
      o.generator == "along" ? ToricGenerator::kAlongMinusAxis : ToricGenerator::kAcrossMinusAxis;
  order.toric_side = o.toric == "front" ? ToricSide::kFront : ToricSide::kBack;
  order.power_form = o.power == "paper" ? PowerForm::kPaper : PowerForm::kExact;
  order.base_rule =
      o.base_rule == "tscherning" ? BaseCurveRule::kTscherning : BaseCurveRule::kVogel;
  order.aspheric_gaze_deg = o.aspheric_gaze_deg;
  SetMultifocal(o, order);
  LG_RETURN_IF_ERROR(ApplyChart(o, order));
  return order;
}

Result<LensOrder> OrderFromOptions(const LensOptions& o) {
  if (!o.sphere_D) return UsageError("--sphere: missing, want the sphere in dioptres");
  LG_RETURN_IF_ERROR(CheckPower(o));
  EyePrescription rx;
  rx.sphere = Diopters(*o.sphere_D);
  rx.cylinder = Diopters(o.cylinder_D);
  if (o.axis_deg) rx.axis = AxisDegrees(*o.axis_deg);
  rx.add = Diopters(o.add_D);
  rx.prism_in = PrismDiopters(o.prism_in);
  rx.prism_up = PrismDiopters(o.prism_up);
  return OrderFromPrescription(rx, o.eye == "left" ? Eye::kLeft : Eye::kRight, o);
}

void SetFrameContour(const FrameModel& frame, double pd_mm, std::optional<double> fitting_height_mm,
                     LensOrder& order) {
  const bool right = order.eye == Eye::kRight;
  // Opening coordinates: +x to the wearer's left, which is toward the nose for the right lens.
  const double inward = 0.5 * frame.boxing.frame_pd_mm() - pd_mm;
  const Eigen::Vector2d pupil(right ? inward : -inward,
                              fitting_height_mm ? *fitting_height_mm - 0.5 * frame.boxing.b_mm : 0);
  order.contour_mm = ContourInLensFrame((right ? frame.right : frame.left).contour_mm, pupil);
}

Result<MadeLens> MakeLens(const LensOrder& given, const LensOptions& o) {
  MadeLens made;
  made.written = given.rx;
  LensOrder order = given;
  if (o.thinning) {
    if (!order.progressive) {
      return UsageError("--thinning: got it without --multifocal progressive or soft, want both");
    }
    made.thinning_down = ThinningPrismDown(order.rx.add);
    order.rx.prism_up = PrismDiopters(order.rx.prism_up.value() - made.thinning_down.value());
  }
  if (IsCompensated(o)) {
    if (o.prism_by == "decentration") {
      return UsageError(
          "--prism-by decentration: not together with a compensated position of wear; possible: "
          "grinding");
    }
    made.refraction_vertex_mm = o.refraction_vertex_mm.value_or(order.vertex_distance_mm);
    made.worn_as = WearPosition{o.pantoscopic_deg, o.face_form_deg, order.vertex_distance_mm};
    LG_ASSIGN(made.wear, CompensateForWear(order, made.refraction_vertex_mm, *made.worn_as));
    made.design = made.wear->design;
    return made;
  }
  if (o.prism_by == "decentration") {
    LG_ASSIGN(made.prism, DesignWithPrism(order, o.max_decentration_mm));
    made.design = made.prism->design;
    return made;
  }
  LG_ASSIGN(made.design, DesignLens(order));
  return made;
}

Result<MadeLens> LensFromOptions(const LensOptions& options) {
  if (!options.lens_file.empty() || !options.front_radii_mm.empty() ||
      !options.back_radii_mm.empty()) {
    LG_ASSIGN(LensDesign design,
              options.lens_file.empty() ? LensFromRadii(options) : LensFromFile(options));
    MadeLens made;
    made.written = design.order.rx;
    made.design = std::move(design);
    return made;
  }
  LG_ASSIGN(const LensOrder order, OrderFromOptions(options));
  return MakeLens(order, options);
}

}  // namespace lorgnette
