// SPDX-License-Identifier: Apache-2.0
#include "tracking/track_smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "tracking/smoothing.h"

namespace lorgnette {
namespace {

// Of the origin's direction (two), its distance (logarithm), and the turn about the camera's axes:
// what a frame tells well is smoothed little.
constexpr std::array<double, 6> kCutoffHz{10, 10, 4, 6, 6, 6};
constexpr double kOutstanding = 3;  // deviations of the noise, from which on motion is motion
constexpr double kExpressionCutoffHz = 6;

struct Run {
  std::size_t first, last;  // frames first .. last - 1
};

std::vector<Run> RunsOf(const HeadTrack& track, const std::vector<bool>& cut_before) {
  std::vector<Run> runs;
  for (std::size_t f = 0; f < track.frames.size(); ++f) {
    if (!track.frames[f].found) continue;
    const bool goes_on = f > 0 && track.frames[f - 1].found && !cut_before[f];
    if (goes_on) {
      runs.back().last = f + 1;
    } else {
      runs.push_back({f, f + 1});
    }
  }
  return runs;
}

double RateOf(const HeadTrack& track, const Run& run) {
  const double seconds = track.frames[run.last - 1].time_s - track.frames[run.first].time_s;
  const double steps = double(run.last - run.first) - 1;
  return seconds > 0 ? std::clamp(steps / seconds, 1.0, 1000.0) : 25.0;
}

}  // namespace

void SmoothTrack(const std::vector<bool>& cut_before, const std::vector<double>& confidence,
                 HeadTrack& track) {
  LG_CHECK_EQ(confidence.size(), track.frames.size());
  LG_CHECK_EQ(cut_before.size(), track.frames.size());
  for (const Run& run : RunsOf(track, cut_before)) {
    const double rate = RateOf(track, run);
    const Eigen::Matrix3d base = track.frames[(run.first + run.last) / 2].camera_from_head.linear();
    const Eigen::Index count = Eigen::Index(run.last - run.first);
    const Eigen::Map<const Eigen::VectorXd> trust(confidence.data() + run.first, count);
    Eigen::MatrixXd channels(count, 6);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Isometry3d& pose = track.frames[run.first + std::size_t(i)].camera_from_head;
      const Eigen::Vector3d& at = pose.translation();
      const Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.linear() * base.transpose()));
      channels.row(i) << at.x() / at.z(), at.y() / at.z(), std::log(at.z()),
          turn.angle() * turn.axis().transpose();
    }
    for (int c = 0; c < 6; ++c) {
      const double stiffness = StiffnessForCutoff(kCutoffHz[std::size_t(c)], rate);
      channels.col(c) = SmoothedKeepingJumps(channels.col(c), trust, stiffness, kOutstanding);
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      Eigen::Isometry3d& pose = track.frames[run.first + std::size_t(i)].camera_from_head;
      const double depth = std::exp(channels(i, 2));
      pose.translation() = depth * Eigen::Vector3d(channels(i, 0), channels(i, 1), 1);
      const Eigen::Vector3d turn = channels.row(i).tail<3>().transpose();
      pose.linear() =
          turn.norm() > 0
              ? Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * base
              : base;
    }
  }
}

void FollowExpression(const std::vector<const FaceLandmarks*>& landmarks,
                      const std::vector<bool>& cut_before, HeadTrack& track) {
  LG_CHECK_EQ(landmarks.size(), track.frames.size());
  const std::size_t points = track.face.positions.size();
  for (const Run& run : RunsOf(track, cut_before)) {
    const Eigen::Index count = Eigen::Index(run.last - run.first);
    Eigen::MatrixXd moves(count, Eigen::Index(2 * points));  // mm across the line of sight
    for (Eigen::Index i = 0; i < count; ++i) {
      TrackedFrame& frame = track.frames[run.first + std::size_t(i)];
      double squares = 0;
      for (std::size_t v = 0; v < points; ++v) {
        const Eigen::Vector3d p = frame.camera_from_head * track.face.positions[v];
        const Eigen::Vector2d error =
            landmarks[run.first + std::size_t(i)]->points[v].head<2>() - track.camera.Project(p);
        squares += error.squaredNorm();
        moves.block<1, 2>(i, Eigen::Index(2 * v)) = (p.z() / track.camera.fx) * error.transpose();
      }
      frame.residual_px = float(std::sqrt(squares / double(points)));
    }
    const double stiffness = StiffnessForCutoff(kExpressionCutoffHz, RateOf(track, run));
    const Eigen::MatrixXd smooth = Smoothed(moves, Eigen::VectorXd::Ones(count), stiffness);
    for (Eigen::Index i = 0; i < count; ++i) {
      TrackedFrame& frame = track.frames[run.first + std::size_t(i)];
      frame.vertices.resize(points);
      const Eigen::Matrix3d head_from_camera = frame.camera_from_head.linear().transpose();
      for (std::size_t v = 0; v < points; ++v) {
        const Eigen::Vector3d move(smooth(i, Eigen::Index(2 * v)),
                                   smooth(i, Eigen::Index(2 * v + 1)), 0);
        frame.vertices[v] = (track.face.positions[v] + head_from_camera * move).cast<float>();
      }
    }
  }
}

}  // namespace lorgnette
