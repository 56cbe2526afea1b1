// SPDX-License-Identifier: Apache-2.0
// The formulas of lens design against exact rays: the power of the finished lens, the correction
// for a tilted frame, and the magnification that an observer sees.
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "optics/long_double_trace.h"
#include "optics/magnification.h"
#include "optics/wear.h"
#include "validation/cost/studies.h"

namespace lorgnette::validation {
namespace {

CostPoint Timed(const char* method, const char* parameter, const std::function<void()>& work,
                int calls, const StopwatchOptions& stopwatch) {
  const Timing timing = TimeOf(
      [&] {
        for (int i = 0; i < calls; ++i) work();
      },
      stopwatch);
  CostPoint point;
  point.method = method;
  point.parameter = parameter;
  point.time = timing.median_ns / calls / 1000;
  point.time_spread = timing.spread_ns / calls / 1000;
  return point;
}

// Strength of an error of power: blur (the length of the power vector) and the worse meridian.
struct PowerError {
  double blur_D, worst_D;
};
PowerError ErrorOf(const PowerVector& error) {
  const double j = std::hypot(error.j0, error.j45);
  return {std::hypot(error.mean, j), std::abs(error.mean) + j};
}

// --- power
// -----------------------------------------------------------------------------------------

Result<CostStudy> PowerStudy(const LensDesign& design, const StopwatchOptions& stopwatch) {
  CostStudy study;
  study.name = "design-power";
  study.title = "Design: the back surface from the order";
  study.reference = "the order, met by the lens' exact back vertex power";
  study.time_unit = "us/lens";
  study.units = {{"D", "of the back vertex power, as blur"}};
  const PowerVector ordered =
      PowerVectorOf({design.order.rx.sphere, design.order.rx.cylinder, design.order.rx.axis});
  LensOrder order = design.order;
  order.center_thickness_mm = design.lens.center_thickness_mm;
  const auto add = [&](const char* method, const LensOrder& as, const auto& make) -> Status {
    LG_ASSIGN(const LensDesign made, make(as));
    CostPoint point = Timed(
        method, "", [&] { (void)make(as); }, 10, stopwatch);
    const PowerVector found = PowerVectorOfLensFrame(SystemOf(made.lens).BackVertexPower());
    const PowerError error =
        ErrorOf({found.mean - ordered.mean, found.j0 - ordered.j0, found.j45 - ordered.j45});
    point.errors = {error.blur_D};
    point.worst = {error.worst_D};
    study.points.push_back(std::move(point));
    return {};
  };
  // Thin: F2 = P - F1, by ordering the power that the exact form turns into that back surface.
  const auto thin = [](const LensOrder& as) -> Result<LensDesign> {
    const double tau = *as.center_thickness_mm / 1000 / as.medium.index_d;
    const double f1 = as.base_curve->value();
    LensOrder changed = as;
    changed.rx.sphere = as.rx.sphere + Diopters(f1 / (1 - tau * f1) - f1);
    return DesignLens(changed);
  };
  order.base_curve = design.front_power;
  LG_RETURN_IF_ERROR(add("thin lens", order, thin));
  order.power_form = PowerForm::kPaper;
  LG_RETURN_IF_ERROR(add("equation (1)", order, DesignLens));
  order.power_form = PowerForm::kExact;
  LG_RETURN_IF_ERROR(add("exact form", order, DesignLens));
  MarkFront(study);
  return study;
}

// --- tilt
// ------------------------------------------------------------------------------------------

constexpr double kPantoscopic_deg = 12;

// The order whose thin lens, tilted about the horizontal, has the power of `rx`.
SphereCylinder UndoThinTilt(const PowerVector& target, double tilt, double index) {
  // The tilted power is linear in the order's three components.
  const auto tilted = [&](const PowerVector& p) {
    return PowerVectorOfLensFrame(ThinTilted(LensFrameMatrix(p), tilt, 0, index));
  };
  Eigen::Matrix3d map;
  const PowerVector unit[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < 3; ++k) {
    const PowerVector column = tilted(unit[k]);
    map.col(k) << column.mean, column.j0, column.j45;
  }
  const Eigen::Vector3d order = map.inverse() * Eigen::Vector3d(target.mean, target.j0, target.j45);
  return MinusCylinderForm({order.x(), order.y(), order.z()});
}

Result<CostStudy> TiltStudy(const LensDesign& design, const StopwatchOptions& stopwatch) {
  WearPosition wear;
  wear.pantoscopic_deg = kPantoscopic_deg;
  wear.vertex_distance_mm = design.order.vertex_distance_mm;
  const double tilt = RadiansFromDegrees(kPantoscopic_deg), n = design.lens.medium.index_d;
  LensOrder order = design.order;
  order.base_curve = design.front_power;
  order.center_thickness_mm = design.lens.center_thickness_mm;
  const PowerVector target = PowerVectorOf({order.rx.sphere, order.rx.cylinder, order.rx.axis});

  CostStudy study;
  study.name = "design-tilt";
  study.title = fmt::format("Design: a frame tilted by {} degrees", kPantoscopic_deg);
  study.reference = "the power that was refracted, against rays through the worn lens";
  study.time_unit = "us/lens";
  study.units = {{"D", "of the power that the eye meets in primary gaze, as blur"}};
  const auto add = [&](const char* method, int calls, const auto& make) -> Status {
    LG_ASSIGN(const LensDesign made, make());
    CostPoint point = Timed(
        method, "", [&] { (void)make(); }, calls, stopwatch);
    LG_ASSIGN(const WornPower worn, MeasureWorn(made.lens, order.eye, wear));
    const PowerError error = ErrorOf(
        {worn.power.mean - target.mean, worn.power.j0 - target.j0, worn.power.j45 - target.j45});
    point.errors = {error.blur_D};
    point.worst = {error.worst_D};
    study.points.push_back(std::move(point));
    return {};
  };
  const auto with = [&](const SphereCylinder& power) {
    LensOrder changed = order;
    changed.rx.sphere = power.sphere;
    changed.rx.cylinder = power.cylinder;
    changed.rx.axis = power.axis;
    return DesignLens(changed);
  };
  LG_RETURN_IF_ERROR(add("as written", 10, [&] { return DesignLens(order); }));
  LG_RETURN_IF_ERROR(add("Martin's rule", 10, [&] {
    // Undoes to first order what the rule predicts for the spherical equivalent.
    const PowerVector gets =
        PowerVectorOf(MartinTilted(Diopters(target.mean), tilt, n, AxisDegrees(180)));
    return with(MinusCylinderForm(
        {2 * target.mean - gets.mean, target.j0 - gets.j0, target.j45 - gets.j45}));
  }));
  LG_RETURN_IF_ERROR(
      add("thin lens, exact tilt", 10, [&] { return with(UndoThinTilt(target, tilt, n)); }));
  LG_RETURN_IF_ERROR(add("traced compensation", 2, [&]() -> Result<LensDesign> {
    LG_ASSIGN(WearCompensation made, CompensateForWear(order, wear.vertex_distance_mm, wear));
    return std::move(made.design);
  }));
  MarkFront(study);
  return study;
}

// --- magnification
// -----------------------------------------------------------------------------------

// What ObserverExact finds, in long double: Newton's steps on the camera ray's tangent.
double MagnificationReference(const Lens& lens, const ObserverGeometry& geometry,
                              const Eigen::Vector2d& feature, const Eigen::Vector2d& guess) {
  using oracle::Real;
  using Vec2 = Eigen::Matrix<Real, 2, 1>;
  const Real plane = Real(lens.center_thickness_mm) + geometry.depth_mm;
  const auto hit = [&](const Vec2& tangent) -> Vec2 {
    const oracle::Vec direction = oracle::Vec(tangent.x(), tangent.y(), 1).normalized();
    const oracle::Trace ray = oracle::TraceLens(lens, oracle::Vec(0, 0, -geometry.camera_mm),
                                                direction, lens.medium.index_d);
    const oracle::Vec at =
        ray.second.point + (plane - ray.second.point.z()) / ray.exit.z() * ray.exit;
    return at.head<2>();
  };
  Vec2 tangent = guess.cast<Real>();
  const Vec2 wanted = feature.cast<Real>();
  constexpr Real kStep = 1e-9L;
  for (int i = 0; i < 3; ++i) {
    const Vec2 at = hit(tangent);
    Eigen::Matrix<Real, 2, 2> slope;
    slope.col(0) = (hit(tangent + Vec2(kStep, 0)) - at) / kStep;
    slope.col(1) = (hit(tangent + Vec2(0, kStep)) - at) / kStep;
    tangent -= (slope.inverse() * (at - wanted)).eval();
  }
  const Real bare = wanted.norm() / (Real(geometry.camera_mm) + plane);
  return double(tangent.dot(wanted) / wanted.norm() / bare);
}

constexpr std::array<double, 4> kHeights_mm = {6, 10, 15, 20};

Result<CostStudy> MagnificationStudy(const Lens& lens, const LensView& view,
                                     const StopwatchOptions& stopwatch) {
  const ObserverGeometry geometry{view.camera_mm, view.face_mm};
  const double n = lens.medium.index_d;
  CostStudy study;
  study.name = "design-magnification";
  study.title = "Design: how much smaller or larger the eye looks";
  study.reference = "long double rays to features 6, 10, 15 and 20 mm off the axis";
  study.time_unit = "us/value";
  study.units = {{"magnification", "of the ratio with and without the lens"},
                 {"px", "of the feature's place in the picture"}};
  const double px_per_mm =
      view.focal_px / (view.camera_mm + lens.center_thickness_mm + view.face_mm);
  std::array<double, kHeights_mm.size()> truth;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Vector2d feature(kHeights_mm[i], 0);
    const auto ray = ObserverExact(lens, n, geometry, feature);
    if (!ray) return Failure("cost: no ray reaches a feature 20 mm off the axis of this lens");
    truth[i] = MagnificationReference(lens, geometry, feature, ray->camera_tangent);
  }
  const auto add = [&](const char* method, int calls, const auto& magnification) {
    volatile double sink = 0;
    CostPoint point = Timed(
        method, "", [&] { sink = magnification(kHeights_mm[1]); }, calls, stopwatch);
    static_cast<void>(sink);
    double sum[2] = {0, 0}, worst[2] = {0, 0};
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double relative = std::abs(magnification(kHeights_mm[i]) - truth[i]);
      const double error[2] = {relative, relative * px_per_mm * kHeights_mm[i]};
      for (int k = 0; k < 2; ++k) {
        sum[k] += error[k] * error[k];
        worst[k] = std::max(worst[k], error[k]);
      }
    }
    for (int k = 0; k < 2; ++k) {
      point.errors.push_back(std::sqrt(sum[k] / double(truth.size())));
      point.worst.push_back(worst[k]);
    }
    study.points.push_back(std::move(point));
  };
  const AstigmaticSystem system = SystemOf(lens);
  const Diopters power(system.BackVertexPower()(0, 0));
  add("thin lens", 1000, [&](double) { return ObserverMagnificationThin(power, geometry); });
  add("thick lens, to first order", 1000, [&](double) {
    return ObserverMagnification(system, lens.center_thickness_mm, geometry)(0, 0);
  });
  add("exact ray", 20, [&](double height) {
    return ObserverExact(lens, n, geometry, {height, 0})->magnification;
  });
  MarkFront(study);
  return study;
}

}  // namespace

Status DesignStudies(const LensDesign& design, const CostOptions& options,
                     std::vector<CostStudy>& studies) {
  LG_ASSIGN(CostStudy power, PowerStudy(design, options.stopwatch));
  studies.push_back(std::move(power));
  LG_ASSIGN(CostStudy tilt, TiltStudy(design, options.stopwatch));
  studies.push_back(std::move(tilt));
  LG_ASSIGN(CostStudy magnification,
            MagnificationStudy(design.lens, options.view, options.stopwatch));
  studies.push_back(std::move(magnification));
  return {};
}

}  // namespace lorgnette::validation
