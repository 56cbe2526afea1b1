// SPDX-License-Identifier: Apache-2.0
#include "tracking/chessboard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "base/units.h"
#include "tracking/opencv_view.h"

namespace lorgnette {
namespace {

constexpr double kSamePlace = 0.01;      // of the picture's width, mean over the corners
constexpr double kBadView = 3;           // times the median error of the views
constexpr double kLeastBadViewPx = 0.3;  // below this no view is bad
constexpr double kWorstFocalError = 0.03, kWeakFocalError = 0.005;
constexpr double kLittleTiltDeg = 20, kLittleReach = 0.7;
constexpr double kSignificant = 3;  // standard errors

// OpenCV counts from the centre of the first pixel, we from its corner.
constexpr double kPixelCentre = 0.5;

struct Solved {
  cv::Mat matrix, distortion, sigma, view_errors;
  std::vector<cv::Mat> turns, shifts;
  double rms = 0;
};

Solved Solve(const std::vector<cv::Point3f>& board, const std::vector<BoardCorners>& views,
             cv::Size size, int flags) {
  std::vector<std::vector<cv::Point2f>> seen;
  for (const BoardCorners& corners : views) {
    std::vector<cv::Point2f>& points = seen.emplace_back();
    for (const Eigen::Vector2d& p : corners) {
      points.emplace_back(float(p.x() - kPixelCentre), float(p.y() - kPixelCentre));
    }
  }
  const std::vector<std::vector<cv::Point3f>> boards(views.size(), board);
  Solved s;
  cv::Mat pose_sigma;
  s.rms = cv::calibrateCamera(boards, seen, size, s.matrix, s.distortion, s.turns, s.shifts,
                              s.sigma, pose_sigma, s.view_errors, flags,
                              {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-12});
  return s;
}

Solved SolveWithFittingModel(const std::vector<cv::Point3f>& board,
                             const std::vector<BoardCorners>& views, cv::Size size) {
  Solved full = Solve(board, views, size, 0);
  constexpr int kK3 = 4, kK3Sigma = 8;
  const bool told =
      std::abs(full.distortion.at<double>(kK3)) > kSignificant * full.sigma.at<double>(kK3Sigma);
  return told ? full : Solve(board, views, size, cv::CALIB_FIX_K3);
}

double TiltDeg(const cv::Mat& turn) {
  cv::Mat rotation;
  cv::Rodrigues(turn, rotation);
  return DegreesFromRadians(std::acos(std::min(1.0, std::abs(rotation.at<double>(2, 2)))));
}

}  // namespace

std::optional<BoardCorners> FindChessboard(const ImageRgb8& picture, const Chessboard& board) {
  cv::Mat grey;
  cv::cvtColor(MatOf(picture), grey, cv::COLOR_RGB2GRAY);
  std::vector<cv::Point2f> found;
  if (!cv::findChessboardCornersSB(grey, {board.columns, board.rows}, found,
                                   cv::CALIB_CB_NORMALIZE_IMAGE)) {
    return std::nullopt;
  }
  // The finder is good to a third of a pixel; the saddle about each corner to a few hundredths.
  double nearest = 1e9;
  for (std::size_t i = 1; i < found.size(); ++i) {
    nearest = std::min(nearest, cv::norm(found[i] - found[i - 1]));
  }
  const int reach = std::clamp(int(0.35 * nearest), 2, 10);
  cv::cornerSubPix(grey, found, {reach, reach}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-3});
  BoardCorners corners;
  for (const cv::Point2f& p : found) {
    corners.emplace_back(double(p.x) + kPixelCentre, double(p.y) + kPixelCentre);
  }
  return corners;
}

bool SameView(const BoardCorners& a, const BoardCorners& b, int width) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).norm();
  return sum < kSamePlace * width * double(a.size());
}

Result<Calibration> Calibrate(const Chessboard& board, int width, int height,
                              const std::vector<BoardCorners>& views) {
  std::vector<cv::Point3f> points;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      points.emplace_back(float(column * board.square_mm), float(row * board.square_mm), 0.0f);
    }
  }
  if (int(views.size()) < kFewestViews) {
    return Failure(fmt::format("got {} different views of the whole board, want at least {}",
                               views.size(), kFewestViews));
  }
  Calibration out;
  Solved solved;
  std::vector<BoardCorners> used = views;
  try {
    solved = SolveWithFittingModel(points, used, {width, height});
    std::vector<double> errors(solved.view_errors.begin<double>(),
                               solved.view_errors.end<double>());
    std::vector<double> sorted = errors;
    std::nth_element(sorted.begin(), sorted.begin() + long(sorted.size() / 2), sorted.end());
    const double limit = std::max(kLeastBadViewPx, kBadView * sorted[sorted.size() / 2]);
    used.clear();
    for (std::size_t v = 0; v < views.size(); ++v) {
      if (errors[v] <= limit) used.push_back(views[v]);
    }
    out.views_left_out = int(views.size() - used.size());
    if (out.views_left_out > 0 && int(used.size()) >= kFewestViews) {
      solved = SolveWithFittingModel(points, used, {width, height});
    }
  } catch (const cv::Exception& e) {
    return Failure("got views that no camera explains (" + e.err +
                   "), want tilted views of a flat board");
  }
  CalibratedCamera& camera = out.camera;
  const cv::Mat &k = solved.matrix, &d = solved.distortion;
  camera.camera = {width,
                   height,
                   k.at<double>(0, 0),
                   k.at<double>(1, 1),
                   k.at<double>(0, 2) + kPixelCentre,
                   k.at<double>(1, 2) + kPixelCentre};
  camera.distortion = {d.at<double>(0), d.at<double>(1), d.at<double>(2), d.at<double>(3),
                       d.at<double>(4)};
  camera.rms_px = solved.rms;
  camera.focal_sigma_px = solved.sigma.at<double>(0);
  camera.views = int(used.size());
  out.view_rms_px.assign(solved.view_errors.begin<double>(), solved.view_errors.end<double>());
  for (const cv::Mat& turn : solved.turns) {
    out.most_tilted_deg = std::max(out.most_tilted_deg, TiltDeg(turn));
  }
  const Eigen::Vector2d middle(width / 2.0, height / 2.0);
  for (const BoardCorners& corners : used) {
    for (const Eigen::Vector2d& p : corners) {
      out.reach = std::max(out.reach, (p - middle).norm() / middle.norm());
    }
  }
  const double focal_error = camera.focal_sigma_px / camera.camera.fx;
  if (!(focal_error <= kWorstFocalError) || !(camera.camera.fx > 1 && camera.camera.fy > 1)) {
    return Failure(
        fmt::format("the views leave the focal length open by {:.0f} per cent, want the "
                    "board tilted by 20 to 45 degrees in several directions",
                    100 * focal_error));
  }
  if (focal_error > kWeakFocalError || out.most_tilted_deg < kLittleTiltDeg) {
    out.notes.push_back(
        fmt::format("the board was tilted by {:.0f} degrees at most: views at 30 to "
                    "45 degrees fix the focal length better",
                    out.most_tilted_deg));
  }
  if (out.reach < kLittleReach) {
    out.notes.push_back(
        "the board never came near the corners of the picture: the distortion is "
        "not known there");
  }
  return out;
}

}  // namespace lorgnette
