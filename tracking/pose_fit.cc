// SPDX-License-Identifier: Apache-2.0
#include "tracking/pose_fit.h"

#include <cmath>

#include "base/linear_algebra.h"

namespace lorgnette {
namespace {

constexpr int kMaxPoseSteps = 30;
constexpr double kConverged = 1e-7;  // radians and mm
constexpr double kNearestMm = 1;     // points nearer to the camera than this do not count

Eigen::Matrix3d Exp(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

struct Equations {
  Matrix6d normal = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  double loss = 0, weighted_squares = 0, inlier_weight = 0;
};

Equations Linearise(const Camera& camera, const std::vector<PointSighting>& sightings,
                    const Eigen::Isometry3d& pose, double scale_px) {
  Equations eq;
  const double c2 = scale_px * scale_px;
  for (const PointSighting& s : sightings) {
    const Eigen::Vector3d arm = pose.linear() * s.head;
    const Eigen::Vector3d p = arm + pose.translation();
    if (!(p.z() > kNearestMm) || s.weight <= 0) continue;
    const double iz = 1 / p.z();
    const Eigen::Vector2d error = s.pixel - camera.Project(p);
    Eigen::Matrix<double, 2, 3> by_point;
    by_point << camera.fx * iz, 0, -camera.fx * p.x() * iz * iz,  //
        0, camera.fy * iz, -camera.fy * p.y() * iz * iz;
    Eigen::Matrix3d turn;  // d(omega x arm) / d omega
    turn << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
    Eigen::Matrix<double, 2, 6> jacobian;
    jacobian << by_point * turn, by_point;
    const double squares = error.squaredNorm();
    const double trust = 1 / (1 + squares / c2);
    const double w = s.weight * trust;
    eq.normal.noalias() += w * jacobian.transpose() * jacobian;
    eq.right.noalias() += w * jacobian.transpose() * error;
    eq.loss += s.weight * c2 * std::log1p(squares / c2);
    eq.weighted_squares += w * squares;
    eq.inlier_weight += w;
  }
  return eq;
}

}  // namespace

Eigen::Isometry3d Moved(const Eigen::Isometry3d& camera_from_head, const Vector6d& motion) {
  Eigen::Isometry3d out = camera_from_head;
  out.linear() = Exp(motion.head<3>()) * camera_from_head.linear();
  out.translation() += motion.tail<3>();
  return out;
}

Vector6d MotionBetween(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(to.linear() * from.linear().transpose()));
  Vector6d motion;
  motion << turn.angle() * turn.axis(), to.translation() - from.translation();
  return motion;
}

PoseFit FitPose(const Camera& camera, const std::vector<PointSighting>& sightings,
                const Eigen::Isometry3d& guess, double scale_px) {
  PoseFit fit;
  fit.camera_from_head = guess;
  Equations eq = Linearise(camera, sightings, guess, scale_px);
  double damping = 1e-6;
  for (int step = 0; step < kMaxPoseSteps; ++step) {
    Matrix6d damped = eq.normal;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-12;
    const Vector6d motion = SolveSymmetric(damped, eq.right);
    if (!motion.allFinite()) break;
    const Eigen::Isometry3d next = Moved(fit.camera_from_head, motion);
    Equations tried = Linearise(camera, sightings, next, scale_px);
    if (tried.loss <= eq.loss) {
      fit.camera_from_head = next;
      eq = tried;
      damping = std::max(1e-9, damping / 10);
      if (motion.norm() < kConverged) break;
    } else {
      damping *= 20;
      if (damping > 1e6) break;
    }
  }
  fit.camera_from_head.linear() =
      Eigen::Quaterniond(fit.camera_from_head.linear()).normalized().toRotationMatrix();
  fit.rms_px = eq.inlier_weight > 0 ? std::sqrt(eq.weighted_squares / eq.inlier_weight) : 0;
  fit.inlier_weight = eq.inlier_weight;
  fit.information = eq.normal;
  return fit;
}

}  // namespace lorgnette
