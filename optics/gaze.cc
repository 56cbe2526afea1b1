// SPDX-License-Identifier: Apache-2.0
#include "optics/gaze.h"

#include <Eigen/Geometry>
#include <cmath>

#include "base/linear_algebra.h"
#include "optics/coddington.h"
#include "optics/trace.h"

namespace lorgnette {

EyePose EyePose::OnAxis(const Lens& lens, double stop_mm) {
  EyePose eye;
  eye.rotation_center = {0, 0, lens.center_thickness_mm + stop_mm};
  eye.vertex_sphere_mm = stop_mm;
  return eye;
}

Eigen::Vector3d Gaze::Direction() const {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), -std::cos(theta)};
}

Eigen::Matrix3d ListingRotation(const Eigen::Vector3d& direction) {
  return ShortestTurn(-Eigen::Vector3d::UnitZ(), direction).toRotationMatrix();
}

GazeVergence EvaluateGaze(const Lens& lens, double index, const EyePose& eye, const Gaze& gaze,
                          double object_mm) {
  GazeVergence result;
  const Eigen::Vector3d own = gaze.Direction();
  const Eigen::Vector3d outward = eye.axes * own;
  const LensTrace out = TraceThrough(lens, {eye.rotation_center, outward}, index);
  result.status = out.status;
  if (out.status != RayStatus::kOk) return result;

  // Light takes the same way back: the hits are known, only the order turns round.
  LensTrace in;
  in.status = RayStatus::kOk;
  in.first = out.second;
  in.second = out.first;
  in.inside_direction = -out.inside_direction;
  in.exit = {out.first.point, -outward};
  result.object_ray = {out.exit.origin, -out.exit.direction};
  result.back_mm = out.first.point;
  const auto exit =
      WavefrontThrough(lens, index, in, SphericalWave(result.object_ray, -1000 / object_mm));
  if (!exit) {
    result.status = RayStatus::kMissesSurface;
    return result;
  }
  const double to_center = (eye.rotation_center - in.exit.origin).dot(in.exit.direction);
  const Wavefront sphere = Propagated(*exit, to_center - eye.vertex_sphere_mm, 1);

  const Eigen::Matrix<double, 3, 2> across = (eye.axes * ListingRotation(own)).leftCols<2>();
  result.vergence_D = across.transpose() * sphere.vergence_D * across;
  const Eigen::Vector2d along(std::cos(gaze.phi), std::sin(gaze.phi));
  const Eigen::Vector2d aside(-along.y(), along.x());
  result.tangential_D = along.dot(result.vergence_D * along);
  result.sagittal_D = aside.dot(result.vergence_D * aside);
  result.power = MinusCylinderForm(PowerVectorOfLensFrame(result.vergence_D));
  return result;
}

GazeErrors ErrorsOf(const GazeVergence& gaze, const Eigen::Matrix2d& back_vertex_power_D) {
  GazeErrors errors;
  errors.oblique_astigmatism_D = gaze.tangential_D - gaze.sagittal_D;
  errors.mean_oblique_D =
      0.5 * (gaze.sagittal_D + gaze.tangential_D) - 0.5 * back_vertex_power_D.trace();
  errors.error = PowerVectorOfLensFrame(gaze.vergence_D - back_vertex_power_D);
  return errors;
}

}  // namespace lorgnette
