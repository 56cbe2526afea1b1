// SPDX-License-Identifier: Apache-2.0
// What an OMA job says of frame, order and lenses, and what we write into it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "geometry/closed_curve.h"
#include "geometry/oma.h"
#include "geometry/parametric_frame.h"

namespace lorgnette {
namespace {

constexpr int kTraceSplinePieces = 90;  // about 1.7 mm each: smooths what 0.01 mm steps leave
constexpr double kOnEdge = 1e-9;        // a ray through a corner meets one of its edges at least
constexpr double kLeastCurve = 0.5, kGreatestCurve = 9;  // dioptres that a rim can be bent to
constexpr int kTraceAngles = 400, kThicknessAngles = 72;

// Distance from the origin to the contour at equal angles.
std::vector<double> Radii(const Polygon2& contour, int count) {
  std::vector<double> radii(static_cast<std::size_t>(count), 0.0);
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * kPi * k / count;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    for (std::size_t i = 0; i < contour.size(); ++i) {
      const Eigen::Vector2d& a = contour[i];
      const Eigen::Vector2d edge = contour[(i + 1) % contour.size()] - a;
      const double crossing = along.x() * edge.y() - along.y() * edge.x();
      if (crossing == 0) continue;
      const double r = (a.x() * edge.y() - a.y() * edge.x()) / crossing;
      const double u = (a.x() * along.y() - a.y() * along.x()) / crossing;
      if (u > -kOnEdge && u < 1 + kOnEdge)
        radii[std::size_t(k)] = std::max(radii[std::size_t(k)], r);
    }
  }
  return radii;
}

}  // namespace

Result<OmaOrder> ReadOmaOrder(const OmaFile& job) {
  OmaOrder order;
  // A label's values, each within limits.
  const auto read = [&](const char* label, double low, double high, double& right,
                        double& left) -> Result<bool> {
    LG_ASSIGN(const OmaPair pair, job.Numbers(label));
    for (const std::optional<double>& value : {pair.right, pair.left}) {
      if (value && !(*value >= low && *value <= high)) {
        return Failure(
            fmt::format("{}:{}: got {}, want {}..{}", job.name(), label, *value, low, high));
      }
    }
    right = pair.right.value_or(right);
    left = pair.left.value_or(left);
    return pair.right.has_value() || pair.left.has_value();
  };
  const auto per_eye = [&](const char* label, double low, double high,
                           const auto& set) -> Result<bool> {
    double right = 0, left = 0;
    LG_ASSIGN(const bool any, read(label, low, high, right, left));
    set(order.rx.right, right);
    set(order.rx.left, left);
    return any;
  };
  LG_ASSIGN(const bool any, per_eye("SPH", -kMaxSphere, kMaxSphere,
                                    [](EyePrescription& e, double v) { e.sphere = Diopters(v); }));
  if (!any) return Failure(job.name() + ":SPH: got no sphere, want an order with SPH");
  LG_RETURN_IF_ERROR(per_eye("CYL", -kMaxCylinder, kMaxCylinder,
                             [](EyePrescription& e, double v) { e.cylinder = Diopters(v); }));
  LG_RETURN_IF_ERROR(
      per_eye("AX", 0, 180, [](EyePrescription& e, double v) { e.axis = AxisDegrees(v); }));
  LG_RETURN_IF_ERROR(
      per_eye("ADD", 0, kMaxAdd, [](EyePrescription& e, double v) { e.add = Diopters(v); }));
  double amount[2] = {0, 0}, base[2] = {0, 0};
  LG_RETURN_IF_ERROR(read("PRVM", 0, kMaxPrism, amount[0], amount[1]));
  LG_RETURN_IF_ERROR(read("PRVA", -360, 360, base[0], base[1]));
  for (int k = 0; k < 2; ++k) {
    EyePrescription& eye = k == 0 ? order.rx.right : order.rx.left;
    const double angle = RadiansFromDegrees(base[k]);
    // As drawn, nasal is at 0 degrees on the right eye and at 180 on the left.
    const double in = (k == 0 ? 1 : -1) * std::cos(angle);
    eye.prism_in = PrismDiopters(amount[k] * in);
    eye.prism_up = PrismDiopters(amount[k] * std::sin(angle));
  }
  LG_ASSIGN(const OmaPair pd, job.Numbers("IPD"));
  if (pd.right && pd.left) {
    // One number is the distance between the pupils, two are each eye's.
    const bool whole = *pd.right == *pd.left && *pd.right >= kMinPd_mm;
    order.rx.pd_right_mm = whole ? *pd.right / 2 : *pd.right;
    order.rx.pd_left_mm = whole ? *pd.left / 2 : *pd.left;
    const double both = order.rx.pd_mm();
    if (!(both >= kMinPd_mm && both <= kMaxPd_mm)) {
      return Failure(fmt::format("{}:IPD: got {} mm between the pupils, want {}..{}", job.name(),
                                 both, kMinPd_mm, kMaxPd_mm));
    }
    order.has_pd = true;
  }
  double vertex[2] = {order.rx.vertex_distance_mm, order.rx.vertex_distance_mm};
  LG_RETURN_IF_ERROR(read("BVD", kMinVertex_mm, kMaxVertex_mm, vertex[0], vertex[1]));
  order.rx.vertex_distance_mm = vertex[0];
  LG_ASSIGN(const OmaPair index, job.Numbers("LIND"));
  order.index = index.right ? index.right : index.left;
  LG_ASSIGN(order.center_thickness_mm, job.Numbers("CTHICK"));
  LG_ASSIGN(OmaPair front, job.Numbers("FRNT"));
  if (front.right) front.right = OmaCurveDiopters(*front.right);
  if (front.left) front.left = OmaCurveDiopters(*front.left);
  order.front_diopters = front;
  return order;
}

OmaFile MakeOmaJob(const Eyewear& eyewear, const Prescription& rx) {
  OmaFile job = *OmaFile::Parse("OMAV=3.12\r\nJOB=1\r\nDO=B\r\n", "job");
  const auto set = [&](const char* label, double right, double left) {
    job.Set(label, fmt::format("{:.2f};{:.2f}", right, left));
  };
  set("SPH", rx.right.sphere.value(), rx.left.sphere.value());
  set("CYL", rx.right.cylinder.value(), rx.left.cylinder.value());
  job.Set("AX", fmt::format("{:.0f};{:.0f}", rx.right.axis.value(), rx.left.axis.value()));
  if (rx.right.add.value() != 0 || rx.left.add.value() != 0) {
    set("ADD", rx.right.add.value(), rx.left.add.value());
  }
  const auto prism = [](const EyePrescription& eye, double nasal, double& amount, double& base) {
    const double x = nasal * eye.prism_in.value(), y = eye.prism_up.value();
    amount = std::hypot(x, y);
    base = std::fmod(DegreesFromRadians(std::atan2(y, x)) + 360, 360);
  };
  double amount[2], base[2];
  prism(rx.right, 1, amount[0], base[0]);
  prism(rx.left, -1, amount[1], base[1]);
  if (amount[0] > 0 || amount[1] > 0) {
    set("PRVM", amount[0], amount[1]);
    set("PRVA", base[0], base[1]);
  }
  set("IPD", rx.pd_right_mm, rx.pd_left_mm);
  set("BVD", eyewear.wearing.vertex_distance_right_mm, eyewear.wearing.vertex_distance_left_mm);
  set("PANTO", eyewear.wearing.pantoscopic_tilt_deg, eyewear.wearing.pantoscopic_tilt_deg);
  set("ZTILT", eyewear.wearing.face_form_deg, eyewear.wearing.face_form_deg);
  set("FCRV", eyewear.frame.frame_curve_diopters, eyewear.frame.frame_curve_diopters);
  job.Set("ETYP", eyewear.frame.mount == FrameMount::kFullRim   ? "1"
                  : eyewear.frame.mount == FrameMount::kHalfRim ? "3"
                                                                : "2");
  job.SetTrace(Eye::kRight, Radii(eyewear.frame.right.contour_mm, kTraceAngles));
  job.SetTrace(Eye::kLeft, Radii(eyewear.frame.left.contour_mm, kTraceAngles));
  return job;
}

Result<FrameModel> FrameAroundTrace(const OmaFile& job, FrameParameters style) {
  LG_ASSIGN(const std::vector<OmaTrace> traces, job.Traces());
  if (traces.empty()) return Failure("trace: the file has no TRCFMT, want a frame trace");
  // Both halves of our frames are alike: the left one's trace, or the right one's mirrored.
  const OmaTrace* left = &traces[0];
  for (const OmaTrace& trace : traces) {
    if (trace.eye == Eye::kLeft) left = &trace;
  }
  const Boxing boxing = MeasureContour(left->contour_mm);
  style.a_mm = boxing.a_mm;
  style.b_mm = boxing.b_mm;
  const int pieces = std::clamp(int(left->contour_mm.size()) / 4, 8, kTraceSplinePieces);
  style.outline = FitClosedSpline(left->contour_mm, pieces).control();
  const auto take = [&](const char* label, double low, double high, double& to) -> Result<bool> {
    LG_ASSIGN(const OmaPair pair, job.Numbers(label));
    const std::optional<double> value = pair.left ? pair.left : pair.right;
    const bool usable = value && *value >= low && *value <= high;
    if (usable) to = *value;
    return usable;
  };
  std::string guessed;
  const auto guess = [&](const char* what, double value, const char* unit) {
    guessed += fmt::format("{}{} {:g} {}", guessed.empty() ? "" : ", ", what, value, unit);
  };
  LG_ASSIGN(const bool has_dbl, take("DBL", 8, 35, style.dbl_mm));
  if (!has_dbl) guess("DBL", style.dbl_mm, "mm");
  LG_ASSIGN(const bool has_tilt, take("PANTO", 0, 25, style.pantoscopic_tilt_deg));
  if (!has_tilt) guess("tilt", style.pantoscopic_tilt_deg, "deg");
  LG_ASSIGN(const bool has_form, take("ZTILT", 0, 25, style.face_form_deg));
  if (!has_form) guess("face form", style.face_form_deg, "deg");
  // A rim of unknown curve is bent to the lens that the job speaks of.
  LG_ASSIGN(const OmaPair front, job.Numbers("FRNT"));
  const double curve = OmaCurveDiopters((front.left ? front.left : front.right).value_or(0));
  const bool has_front = curve >= kLeastCurve && curve <= kGreatestCurve;
  if (has_front) style.frame_curve_diopters = curve;
  LG_ASSIGN(const bool has_curve,
            take("FCRV", kLeastCurve, kGreatestCurve, style.frame_curve_diopters));
  if (!has_front && !has_curve) guess("frame curve", style.frame_curve_diopters, "D");
  LG_ASSIGN(const OmaPair make, job.Numbers("FTYP"));
  LG_ASSIGN(const OmaPair edge, job.Numbers("ETYP"));
  if (make.left == 3 || edge.left == 2) {
    style.mount = FrameMount::kRimless;
  } else if (edge.left == 3) {
    style.mount = FrameMount::kHalfRim;
  }
  FrameModel frame = BuildFrame(style);
  frame.notes.push_back("built around the trace of " + job.name());
  if (!guessed.empty()) frame.notes.push_back("guessed, since the job does not say: " + guessed);
  return frame;
}

void SetLensResults(OmaFile& job, const Eyewear& eyewear) {
  constexpr int kAngles = kThicknessAngles;
  const auto pair = [](double right, double left) {
    return fmt::format("{:.2f};{:.2f}", right, left);
  };
  const auto right = EdgeThicknessByAngle(eyewear.right, eyewear.frame.right, kAngles);
  const auto left = EdgeThicknessByAngle(eyewear.left, eyewear.frame.left, kAngles);
  const LensDesign &r = eyewear.right.lens.design(), &l = eyewear.left.lens.design();
  const Boxing rb = MeasureContour(eyewear.frame.right.contour_mm),
               lb = MeasureContour(eyewear.frame.left.contour_mm);
  job.Set("HBOX", pair(rb.a_mm, lb.a_mm));
  job.Set("VBOX", pair(rb.b_mm, lb.b_mm));
  job.Set("FED", pair(rb.effective_diameter_mm, lb.effective_diameter_mm));
  job.Set("CIRC", pair(rb.circumference_mm, lb.circumference_mm));
  job.Set("DBL", fmt::format("{:.2f}", eyewear.frame.boxing.dbl_mm));
  job.Set("LIND", fmt::format("{:.3f};{:.3f}", r.lens.medium.index_d, l.lens.medium.index_d));
  // A front of F1 at the lens' index has the curve F1 * 0.530 / (n - 1) at the tooling index.
  const auto tooling = [](const LensDesign& d) {
    return d.front_power.value() * 0.530 / (d.lens.medium.index_d - 1);
  };
  job.Set("TIND", "1.530");
  job.Set("FRNT", pair(tooling(r), tooling(l)));
  const auto back = [](const LensDesign& d) {  // the flatter meridian, at the tooling index
    return d.back_power_axis.value() * 0.530 / (d.lens.medium.index_d - 1);
  };
  job.Set("BACK", pair(back(r), back(l)));
  job.Set("DIA", pair(r.min_blank_mm, l.min_blank_mm));
  job.Set("CTHICK", pair(r.lens.center_thickness_mm, l.lens.center_thickness_mm));
  const auto angle = [](std::vector<double>::const_iterator at, const std::vector<double>& of) {
    return int(at - of.begin()) * 360 / kAngles;
  };
  const auto rmax = std::max_element(right.begin(), right.end());
  const auto lmax = std::max_element(left.begin(), left.end());
  const auto rmin = std::min_element(right.begin(), right.end());
  const auto lmin = std::min_element(left.begin(), left.end());
  job.Set("THKP", pair(*rmax, *lmax));
  job.Set("THKA", fmt::format("{};{}", angle(rmax, right), angle(lmax, left)));
  job.Set("THNP", pair(*rmin, *lmin));
  job.Set("THNA", fmt::format("{};{}", angle(rmin, right), angle(lmin, left)));
  job.SetEdgeThickness(Eye::kRight, right, Radii(eyewear.frame.right.contour_mm, kAngles));
  job.SetEdgeThickness(Eye::kLeft, left, Radii(eyewear.frame.left.contour_mm, kAngles));
}

}  // namespace lorgnette
