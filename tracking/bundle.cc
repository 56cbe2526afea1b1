// SPDX-License-Identifier: Apache-2.0
#include "tracking/bundle.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <array>
#include <cmath>
#include <memory>

namespace lorgnette {
namespace {

using Pose = std::array<double, 6>;  // rotation vector, then shift

// Where a point is seen, for a camera whose focal lengths are scaled by exp(log_scale).
struct Reprojection {
  Camera camera;
  Eigen::Vector2d pixel;
  double scale;  // weight over sigma

  template <typename T>
  bool operator()(const T* pose, const T* point, const T* log_scale, T* residual) const {
    T p[3];
    ceres::AngleAxisRotatePoint(pose, point, p);
    for (int k = 0; k < 3; ++k) p[k] += pose[3 + k];
    if (p[2] < T(1)) return false;
    const T zoom = exp(log_scale[0]);
    residual[0] = scale * (camera.fx * zoom * p[0] / p[2] + camera.cx - pixel.x());
    residual[1] = scale * (camera.fy * zoom * p[1] / p[2] + camera.cy - pixel.y());
    return true;
  }
};

struct DepthPrior {
  Eigen::Vector3d mean, ray;
  double inverse_sigma;

  template <typename T>
  bool operator()(const T* point, T* residual) const {
    residual[0] = T(0);
    for (int k = 0; k < 3; ++k) residual[0] += (point[k] - mean[k]) * (ray[k] * inverse_sigma);
    return true;
  }
};

struct FocalPrior {
  double inverse_sigma, present;  // logarithm of the present value over the prior's
  template <typename T>
  bool operator()(const T* log_scale, T* residual) const {
    residual[0] = (log_scale[0] + present) * inverse_sigma;
    return true;
  }
};

}  // namespace

BundleReport FitBundle(const std::vector<BundleSighting>& sightings, const BundleOptions& options,
                       Camera& camera, std::vector<Eigen::Isometry3d>& camera_from_head,
                       std::vector<BundlePoint>& points) {
  std::vector<Pose> poses(camera_from_head.size());
  for (std::size_t f = 0; f < poses.size(); ++f) {
    const Eigen::AngleAxisd turn(camera_from_head[f].linear());
    Eigen::Map<Eigen::Vector3d>(poses[f].data()) = turn.angle() * turn.axis();
    Eigen::Map<Eigen::Vector3d>(poses[f].data() + 3) = camera_from_head[f].translation();
  }
  double log_scale = 0;
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::CauchyLoss loss(2);
  ceres::Problem problem(problem_options);
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (const BundleSighting& s : sightings) {
    auto* cost = new ceres::AutoDiffCostFunction<Reprojection, 2, 6, 3, 1>(
        new Reprojection{camera, s.pixel, std::sqrt(s.weight) / options.sigma_px});
    problem.AddResidualBlock(cost, &loss, poses[s.frame].data(), points[s.point].head.data(),
                             &log_scale);
  }
  for (BundlePoint& point : points) {
    if (!problem.HasParameterBlock(point.head.data())) continue;
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<DepthPrior, 1, 3>(
                                 new DepthPrior{point.prior, point.ray, 1 / options.sigma_mm}),
                             nullptr, point.head.data());
    ordering->AddElementToGroup(point.head.data(), 0);
  }
  for (Pose& pose : poses) {
    if (problem.HasParameterBlock(pose.data())) ordering->AddElementToGroup(pose.data(), 1);
  }
  BundleReport report;
  if (!problem.HasParameterBlock(&log_scale)) return report;
  ordering->AddElementToGroup(&log_scale, 1);
  const bool free_focal = options.focal_log_sigma > 0;
  if (free_focal) {
    const double present =
        options.focal_prior_px > 0 ? std::log(camera.fx / options.focal_prior_px) : 0;
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<FocalPrior, 1, 1>(
                                 new FocalPrior{1 / options.focal_log_sigma, present}),
                             nullptr, &log_scale);
  } else {
    problem.SetParameterBlockConstant(&log_scale);
  }
  if (double* fixed = poses[options.fixed_frame].data(); problem.HasParameterBlock(fixed)) {
    problem.SetParameterBlockConstant(fixed);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.linear_solver_ordering = ordering;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = 1e-7;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable()) return report;
  report.usable = true;
  if (free_focal) {
    camera.fx *= std::exp(log_scale);
    camera.fy *= std::exp(log_scale);
  }
  for (std::size_t f = 0; f < poses.size(); ++f) {
    const Eigen::Map<const Eigen::Vector3d> turn(poses[f].data());
    camera_from_head[f].linear() =
        turn.norm() > 0 ? Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix()
                        : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    camera_from_head[f].translation() = Eigen::Map<const Eigen::Vector3d>(poses[f].data() + 3);
  }
  double squares = 0, total = 0;
  for (const BundleSighting& s : sightings) {
    const Eigen::Vector3d p = camera_from_head[s.frame] * points[s.point].head;
    squares += s.weight * (camera.Project(p) - s.pixel).squaredNorm();
    total += s.weight;
  }
  report.rms_px = total > 0 ? std::sqrt(squares / total) : 0;
  return report;
}

}  // namespace lorgnette
