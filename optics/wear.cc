// SPDX-License-Identifier: Apache-2.0
#include "optics/wear.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace lorgnette {
namespace {

constexpr int kMaxWearSteps = 40;
constexpr double kMaxTilt_deg = 45;

double Size(const PowerVector& p) {
  return std::max({std::abs(p.mean), std::abs(p.j0), std::abs(p.j45)});
}

}  // namespace

EyePose WornEye(const Lens& lens, Eye eye, const WearPosition& wear, double stop_mm) {
  const double panto = RadiansFromDegrees(wear.pantoscopic_deg);
  const double wrap = NasalSign(eye) * RadiansFromDegrees(wear.face_form_deg);
  // The lens' normal rises by the tilt and turns toward the nose by the face form.
  const Eigen::Matrix3d head_from_lens = (Eigen::AngleAxisd(wrap, Eigen::Vector3d::UnitY()) *
                                          Eigen::AngleAxisd(-panto, Eigen::Vector3d::UnitX()))
                                             .toRotationMatrix();
  EyePose pose;
  pose.axes = head_from_lens.transpose();
  pose.vertex_sphere_mm = stop_mm;
  pose.rotation_center =
      Eigen::Vector3d(0, 0, lens.center_thickness_mm) + stop_mm * pose.axes.col(2);
  return pose;
}

Result<WornPower> MeasureWorn(const Lens& lens, Eye eye, const WearPosition& wear) {
  const EyePose pose = WornEye(lens, eye, wear);
  const GazeVergence gaze = EvaluateGaze(lens, lens.medium.index_d, pose, {0, 0});
  if (gaze.status != RayStatus::kOk) {
    return Failure(
        fmt::format("wear: no ray reaches the eye through a lens tilted by {} and {} "
                    "degrees; possible: less tilt",
                    wear.pantoscopic_deg, wear.face_form_deg));
  }
  WornPower worn;
  worn.power = PowerVectorOfLensFrame(gaze.vergence_D);
  // The object's light is bent into the line of sight, toward the base.
  const Eigen::Vector3d in = pose.axes.transpose() * gaze.object_ray.direction;
  worn.prism_in = NasalSign(eye) * -100 * in.x() / in.z();
  worn.prism_up = -100 * in.y() / in.z();
  return worn;
}

Result<WearCompensation> CompensateForWear(const LensOrder& order, double refraction_vertex_mm,
                                           const WearPosition& wear) {
  for (const double tilt : {wear.pantoscopic_deg, wear.face_form_deg}) {
    if (!(std::abs(tilt) <= kMaxTilt_deg)) {
      return UsageError(fmt::format("wear: tilt: got {} degrees, want {}..{}", tilt, -kMaxTilt_deg,
                                    kMaxTilt_deg));
    }
  }
  WearCompensation result;
  result.target =
      VertexCompensated(PowerVectorOf({order.rx.sphere, order.rx.cylinder, order.rx.axis}),
                        refraction_vertex_mm - wear.vertex_distance_mm);
  LensOrder made = order;
  made.vertex_distance_mm = wear.vertex_distance_mm;
  PowerVector asked = result.target;
  for (int i = 0; i < kMaxWearSteps; ++i) {
    const SphereCylinder form =
        order.rx.cylinder > Diopters(0) ? PlusCylinderForm(asked) : MinusCylinderForm(asked);
    made.rx.sphere = form.sphere;
    made.rx.cylinder = form.cylinder;
    made.rx.axis = form.axis;
    LG_ASSIGN(result.design, DesignLens(made));
    LG_ASSIGN(result.worn, MeasureWorn(result.design.lens, order.eye, wear));
    const PowerVector& got = result.worn.power;
    const PowerVector missing{result.target.mean - got.mean, result.target.j0 - got.j0,
                              result.target.j45 - got.j45};
    if (Size(missing) < kWearTolerance_D) {
      made.rx = order.rx;
      LG_ASSIGN(const LensDesign plain, DesignLens(made));
      LG_ASSIGN(result.untouched, MeasureWorn(plain.lens, order.eye, wear));
      return result;
    }
    asked = {asked.mean + missing.mean, asked.j0 + missing.j0, asked.j45 + missing.j45};
    // Keep the first lens' front: the rule would follow the correction by steps.
    if (!made.base_curve) made.base_curve = result.design.front_power;
  }
  return Failure("wear: the compensated order does not settle; possible: less tilt");
}

Eigen::Matrix2d ThinTilted(const Eigen::Matrix2d& power_D, double tilt, double axis_angle,
                           double index) {
  const double inside = std::asin(std::sin(tilt) / index);
  const double gain = (index * std::cos(inside) - std::cos(tilt)) / (index - 1);
  Eigen::Matrix2d turn;
  turn << std::cos(axis_angle), -std::sin(axis_angle), std::sin(axis_angle), std::cos(axis_angle);
  const Eigen::Vector2d stretch(1, 1 / std::cos(tilt));
  const Eigen::Matrix2d own = turn.transpose() * power_D * turn;
  return gain * turn * (stretch.asDiagonal() * own * stretch.asDiagonal()) * turn.transpose();
}

SphereCylinder MartinTilted(Diopters sphere, double tilt, double index, AxisDegrees tilt_axis) {
  const double s = sphere.value() * (1 + std::sin(tilt) * std::sin(tilt) / (2 * index));
  return {Diopters(s), Diopters(s * std::tan(tilt) * std::tan(tilt)), tilt_axis};
}

}  // namespace lorgnette
