// SPDX-License-Identifier: Apache-2.0
// Pictures of a chessboard as a known camera with a known lens would take them.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/image.h"
#include "tracking/chessboard.h"

namespace lorgnette::test {

// A wide webcam's: barrel distortion of 11 px at the corners of 640 x 480, a middle that is off.
inline CalibratedCamera WideCamera() {
  CalibratedCamera c;
  c.camera = {640, 480, 560, 558, 327, 236};
  c.distortion = {-0.12, 0.02, 0.0008, -0.0005, 0};
  return c;
}

class BoardPainter {
 public:
  BoardPainter(const CalibratedCamera& camera, const Chessboard& board)
      : camera_(camera.camera), board_(board) {
    for (int y = 0; y < kFine * camera_.height; ++y) {
      for (int x = 0; x < kFine * camera_.width; ++x) {
        const Eigen::Vector2d at =
            camera_.Direction((x + 0.5) / kFine, (y + 0.5) / kFine).head<2>();
        rays_.push_back(camera.distortion.Ideal(at).value_or(at).cast<float>());
      }
    }
  }

  // Board space: x along the columns, y down the rows, from the first inner corner, mm.
  ImageRgb8 Paint(const Eigen::Isometry3d& camera_from_board) const {
    const Eigen::Isometry3d board_from_camera = camera_from_board.inverse();
    const Eigen::Vector3d eye = board_from_camera.translation();
    std::vector<int> sums(std::size_t(camera_.width) * std::size_t(camera_.height), 0);
    for (int y = 0; y < kFine * camera_.height; ++y) {
      for (int x = 0; x < kFine * camera_.width; ++x) {
        const Eigen::Vector2f& r =
            rays_[std::size_t(y) * std::size_t(kFine * camera_.width) + std::size_t(x)];
        const Eigen::Vector3d ray =
            board_from_camera.linear() * Eigen::Vector3d(double(r.x()), double(r.y()), 1);
        const Eigen::Vector3d p = eye - eye.z() / ray.z() * ray;
        sums[std::size_t(y / kFine) * std::size_t(camera_.width) + std::size_t(x / kFine)] +=
            Shade(p.x() / board_.square_mm, p.y() / board_.square_mm);
      }
    }
    ImageRgb8 out(camera_.width, camera_.height);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c)
        out.data[3 * i + c] = std::uint8_t(sums[i] / (kFine * kFine));
    }
    return out;
  }

 private:
  static constexpr int kFine = 2;  // samples a pixel along each side
  // Plus and minus one by turns, with edges as soft as a pixel is wide.
  static double Wave(double t) {
    constexpr double kSoft = 0.03;
    const double off = t - std::round(t);
    const double side = std::clamp(off / kSoft, -1.0, 1.0);
    return int(std::round(t)) % 2 == 0 ? side : -side;
  }
  // Squares surround the inner corners; a white margin surrounds the squares.
  int Shade(double column, double row) const {
    const bool outside = column < -1 || row < -1 || column > board_.columns || row > board_.rows;
    const bool paper =
        column > -2 && row > -2 && column < board_.columns + 1 && row < board_.rows + 1;
    if (outside) return paper ? 225 : 90;
    return int(127.5 - 97.5 * Wave(column) * Wave(row));
  }

  Camera camera_;
  Chessboard board_;
  std::vector<Eigen::Vector2f> rays_;
};

// The board's middle at (x, y) mm across and `distance_mm` away, turned about both of its axes.
inline Eigen::Isometry3d BoardPose(const Chessboard& board, double about_y_deg, double about_x_deg,
                                   double x, double y, double distance_mm) {
  const double degree = std::acos(-1.0) / 180;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(about_y_deg * degree, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(about_x_deg * degree, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  const Eigen::Vector3d middle(board.square_mm * (board.columns - 1) / 2,
                               board.square_mm * (board.rows - 1) / 2, 0);
  pose.translation() = Eigen::Vector3d(x, y, distance_mm) - pose.linear() * middle;
  return pose;
}

// Twelve views such as a careful user takes: tilted every way, into every corner.
inline std::vector<Eigen::Isometry3d> BoardPoses(const Chessboard& board) {
  return {BoardPose(board, 0, 0, 0, 0, 420),         BoardPose(board, 35, 0, 20, 0, 420),
          BoardPose(board, -35, 0, -20, 0, 420),     BoardPose(board, 0, 35, 0, 15, 400),
          BoardPose(board, 0, -35, 0, -15, 400),     BoardPose(board, 25, 20, 95, 60, 420),
          BoardPose(board, -25, 20, -95, 60, 420),   BoardPose(board, 25, -20, 95, -60, 420),
          BoardPose(board, -25, -20, -95, -60, 420), BoardPose(board, 30, 25, 0, 0, 520),
          BoardPose(board, -15, 30, 60, 0, 360),     BoardPose(board, 15, -30, -60, 20, 380)};
}

}  // namespace lorgnette::test
