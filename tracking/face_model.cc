// SPDX-License-Identifier: Apache-2.0
#include "tracking/face_model.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/linear_algebra.h"
#include "base/units.h"

namespace lorgnette {
namespace {

// The corneal apex stands before the mean of the lid margins by this share of the pupil distance
// (2.0 mm at 64, on the scanned mean head; docs/tracking.md).
constexpr double kApexBeforeLids = 0.031;

// Landmarks scatter and slide by this share of the pupil distance (docs/tracking.md).
constexpr double kLandmarkSigma = 0.03;
// How far a personal face may leave the canonical one: across and up, and in depth (mm).
const Eigen::Vector3d kPriorSigma_mm(20, 20, 2);
constexpr double kFrontalWithinDeg =
    10;                        // weight of a frame falls with the angle to its most frontal
constexpr int kFitRounds = 3;  // of poses and points in turn
constexpr std::size_t kMostFrames = 60;  // frames that shape the face

Eigen::Vector3d MeanOf(const std::vector<Eigen::Vector3d>& points, const std::array<int, 4>& ids) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int i : ids) sum += points[std::size_t(i)];
  return sum / double(ids.size());
}

// Level with the lid margins.
Eigen::Vector3d Apex(const std::vector<Eigen::Vector3d>& points, const EyeLandmarks& eye) {
  const Eigen::Vector3d corners =
      (points[std::size_t(eye.outer)] + points[std::size_t(eye.inner)]) / 2;
  const Eigen::Vector3d lids = (MeanOf(points, eye.upper) + MeanOf(points, eye.lower)) / 2;
  return {corners.x(), (corners.y() + lids.y()) / 2, lids.z()};
}

double AngleToCamera(const Eigen::Isometry3d& camera_from_head) {
  const Eigen::Vector3d out_of_face = camera_from_head.linear().col(2);
  return std::acos(std::clamp(-out_of_face.z(), -1.0, 1.0));
}

}  // namespace

Eigen::Matrix3d BestRotation(const std::vector<Eigen::Vector3d>& a,
                             const std::vector<Eigen::Vector3d>& b,
                             const std::vector<double>& weights) {
  Eigen::Vector3d mean_a = Eigen::Vector3d::Zero(), mean_b = Eigen::Vector3d::Zero();
  double total = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += weights[i] * a[i];
    mean_b += weights[i] * b[i];
    total += weights[i];
  }
  mean_a /= total;
  mean_b /= total;
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) {
    cross += weights[i] * (b[i] - mean_b) * (a[i] - mean_a).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1, 1,
                       (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

Pupils PupilsOf(const std::vector<Eigen::Vector3d>& points) {
  Pupils pupils{Apex(points, kRightEye), Apex(points, kLeftEye)};
  const double before_lids = kApexBeforeLids * pupils.distance();
  pupils.right.z() += before_lids;
  pupils.left.z() += before_lids;
  return pupils;
}

Similarity HeadFromPoints(const std::vector<Eigen::Vector3d>& points,
                          const CanonicalMesh& canonical, double pd_mm) {
  LG_CHECK_EQ(points.size(), std::size_t(kLandmarks));
  Similarity head;
  head.rotation = BestRotation(points, canonical.mesh.positions, canonical.rigid_weight);
  // The points, roughly upright, against their mirror image: half of the rotation between the two
  // turns the plane of symmetry to x = 0.
  std::vector<Eigen::Vector3d> turned(points.size()), mirrored(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) turned[i] = head.rotation * points[i];
  for (std::size_t i = 0; i < points.size(); ++i) {
    mirrored[i] = turned[std::size_t(canonical.mirror[i])].cwiseProduct(Eigen::Vector3d(-1, 1, 1));
  }
  Eigen::AngleAxisd half(BestRotation(turned, mirrored, canonical.rigid_weight));
  half.angle() /= 2;
  head.rotation = half.toRotationMatrix() * head.rotation;
  for (std::size_t i = 0; i < points.size(); ++i) turned[i] = head.rotation * points[i];
  const Similarity size = HeadFromPupils(PupilsOf(turned), pd_mm);
  head.scale = size.scale;
  head.shift = size.shift;
  return head;
}

Similarity HeadFromPupils(const Pupils& pupils, double pd_mm) {
  Similarity head;
  head.scale = pd_mm / pupils.distance();
  head.shift = -head.scale * (pupils.right + pupils.left) / 2;
  return head;
}

Eigen::Isometry3d Similarity::Rebased(const Eigen::Isometry3d& camera_from_point) const {
  Eigen::Isometry3d camera_from_head = Eigen::Isometry3d::Identity();
  camera_from_head.linear() = camera_from_point.linear() * rotation.transpose();
  camera_from_head.translation() =
      scale * camera_from_point.translation() - camera_from_head.linear() * shift;
  return camera_from_head;
}

std::vector<Eigen::Vector3d> CanonicalHead(const CanonicalMesh& canonical, double pd_mm) {
  const Similarity head = HeadFromPoints(canonical.mesh.positions, canonical, pd_mm);
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& p : canonical.mesh.positions) points.push_back(head(p));
  return points;
}

PoseFit FitLandmarkPose(const Camera& camera, const std::vector<Eigen::Vector3d>& head,
                        const std::vector<double>& weights, const FaceLandmarks& landmarks) {
  const auto pixel = [&](int i) {
    return Eigen::Vector2d(landmarks.points[std::size_t(i)].head<2>());
  };
  const Eigen::Vector2d right = pixel(kRightEye.outer), left = pixel(kLeftEye.outer);
  const double span_mm =
      (head[std::size_t(kLeftEye.outer)] - head[std::size_t(kRightEye.outer)]).norm();
  const double span_px = std::max(1.0, (left - right).norm());
  Eigen::Isometry3d guess = Eigen::Isometry3d::Identity();
  const double roll = std::atan2(left.y() - right.y(), left.x() - right.x());
  guess.linear() = Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                   Eigen::Vector3d(1, -1, -1).asDiagonal();
  const double depth = camera.fx * span_mm / span_px;
  const Eigen::Vector2d middle = (right + left) / 2;
  guess.translation() = depth * camera.Direction(middle.x(), middle.y());
  std::vector<PointSighting> sightings;
  for (std::size_t i = 0; i < head.size(); ++i) {
    if (weights[i] > 0) sightings.push_back({head[i], landmarks.points[i].head<2>(), weights[i]});
  }
  return FitPose(camera, sightings, guess, 2 * kLandmarkSigma * span_px);
}

std::vector<Eigen::Vector3d> ShapeFromLandmarks(const Camera& camera,
                                                const std::vector<Eigen::Vector3d>& prior,
                                                const Eigen::Vector3d& prior_sigma_mm,
                                                const std::vector<const FaceLandmarks*>& frames,
                                                const std::vector<Eigen::Isometry3d>& poses) {
  const std::size_t stride = std::max<std::size_t>(1, frames.size() / kMostFrames);
  double most_frontal = kPi;
  for (std::size_t f = 0; f < frames.size(); f += stride) {
    if (frames[f] != nullptr) most_frontal = std::min(most_frontal, AngleToCamera(poses[f]));
  }
  double total = 0;
  std::vector<double> frame_weight(frames.size(), 0);
  for (std::size_t f = 0; f < frames.size(); f += stride) {
    if (frames[f] == nullptr) continue;
    const double off =
        (AngleToCamera(poses[f]) - most_frontal) / RadiansFromDegrees(kFrontalWithinDeg);
    total += frame_weight[f] = std::exp(-0.5 * off * off);
  }
  const Eigen::Vector3d stiffness = prior_sigma_mm.cwiseAbs2().cwiseInverse();
  const double sigma_mm = kLandmarkSigma * PupilsOf(prior).distance();
  std::vector<Eigen::Vector3d> head = prior;
  for (int round = 0; round < kFitRounds; ++round) {
    for (std::size_t i = 0; i < head.size(); ++i) {
      Eigen::Matrix3d normal = stiffness.asDiagonal();
      Eigen::Vector3d right = stiffness.cwiseProduct(prior[i] - head[i]);
      for (std::size_t f = 0; f < frames.size(); f += stride) {
        if (frame_weight[f] <= 0) continue;
        const Eigen::Vector3d p = poses[f] * head[i];
        const double px_per_mm = camera.fx / p.z();
        const double sigma_px = sigma_mm * px_per_mm;
        Eigen::Matrix<double, 2, 3> by_point;
        by_point << px_per_mm, 0, -px_per_mm * p.x() / p.z(),  //
            0, px_per_mm, -px_per_mm * p.y() / p.z();
        by_point *= poses[f].linear();
        const Eigen::Vector2d error = frames[f]->points[i].head<2>() - camera.Project(p);
        // The frames' errors are not independent: together they count as one.
        const double w = frame_weight[f] / total / (sigma_px * sigma_px) /
                         (1 + error.squaredNorm() / (9 * sigma_px * sigma_px));
        normal += w * by_point.transpose() * by_point;
        right += w * by_point.transpose() * error;
      }
      head[i] += SolveSymmetric(normal, right);
    }
  }
  return head;
}

std::vector<Eigen::Vector3d> FitFace(const Camera& camera, const CanonicalMesh& canonical,
                                     const std::vector<const FaceLandmarks*>& frames, double pd_mm,
                                     std::vector<Eigen::Isometry3d>& poses) {
  const std::vector<Eigen::Vector3d> prior = CanonicalHead(canonical, pd_mm);
  std::vector<Eigen::Vector3d> head = prior;
  poses.assign(frames.size(), Eigen::Isometry3d::Identity());
  for (int round = 0; round <= kFitRounds; ++round) {
    for (std::size_t f = 0; f < frames.size(); ++f) {
      if (frames[f] == nullptr) continue;
      poses[f] = FitLandmarkPose(camera, head, canonical.rigid_weight, *frames[f]).camera_from_head;
    }
    if (round == kFitRounds) break;
    head = ShapeFromLandmarks(camera, prior, kPriorSigma_mm, frames, poses);
    const Similarity aligned = HeadFromPoints(head, canonical, pd_mm);
    for (Eigen::Vector3d& p : head) p = aligned(p);
  }
  return head;
}

}  // namespace lorgnette
