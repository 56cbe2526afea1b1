// SPDX-License-Identifier: Apache-2.0
#include "tracking/lens_distortion.h"

#include <Eigen/LU>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/check.h"
#include "tracking/opencv_view.h"

namespace lorgnette {
namespace {

constexpr int kMostSteps = 40;
constexpr double kSettled = 1e-14;
constexpr double kNowhere = -1e4;  // px, outside of every picture

}  // namespace

Eigen::Vector2d LensDistortion::Distorted(const Eigen::Vector2d& ideal) const {
  const double x = ideal.x(), y = ideal.y(), r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

std::optional<Eigen::Vector2d> LensDistortion::Ideal(const Eigen::Vector2d& distorted) const {
  Eigen::Vector2d p = distorted;
  for (int step = 0; step < kMostSteps; ++step) {
    const double x = p.x(), y = p.y(), r2 = x * x + y * y;
    const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double slope = 2 * (k1 + r2 * (2 * k2 + 3 * r2 * k3));  // of radial by r2, doubled
    Eigen::Matrix2d by_ideal;
    by_ideal << radial + slope * x * x + 2 * p1 * y + 6 * p2 * x,
        slope * x * y + 2 * (p1 * x + p2 * y), slope * x * y + 2 * (p1 * x + p2 * y),
        radial + slope * y * y + 6 * p1 * y + 2 * p2 * x;
    // Past the fold, where the picture would turn over, there is nothing to find.
    if (!(by_ideal.determinant() > 0) || !(by_ideal.trace() > 0)) return std::nullopt;
    const Eigen::Vector2d move = by_ideal.inverse() * (distorted - Distorted(p));
    p += move;
    if (!p.allFinite()) return std::nullopt;
    if (move.norm() <= kSettled * (1 + p.norm())) return p;
  }
  return std::nullopt;
}

struct PictureRectifier::Maps {
  // Where each pixel of the rectified picture comes from, and each of the frame, in fixed point.
  cv::Mat frame_at, frame_part, rectified_at, rectified_part;
};

PictureRectifier::PictureRectifier(const Camera& camera, const LensDistortion& distortion)
    : maps_(std::make_unique<Maps>()) {
  cv::Mat from_frame(camera.height, camera.width, CV_32FC2);
  cv::Mat from_rectified(camera.height, camera.width, CV_32FC2);
  const auto index_of = [&](const Eigen::Vector2d& at) {
    return cv::Vec2f(float(camera.fx * at.x() + camera.cx - 0.5),
                     float(camera.fy * at.y() + camera.cy - 0.5));
  };
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2d at = camera.Direction(x + 0.5, y + 0.5).head<2>();
      from_frame.at<cv::Vec2f>(y, x) = index_of(distortion.Distorted(at));
      const auto ideal = distortion.Ideal(at);
      from_rectified.at<cv::Vec2f>(y, x) =
          ideal ? index_of(*ideal) : cv::Vec2f(float(kNowhere), float(kNowhere));
    }
  }
  cv::convertMaps(from_frame, cv::noArray(), maps_->frame_at, maps_->frame_part, CV_16SC2);
  cv::convertMaps(from_rectified, cv::noArray(), maps_->rectified_at, maps_->rectified_part,
                  CV_16SC2);
}
PictureRectifier::PictureRectifier(PictureRectifier&&) noexcept = default;
PictureRectifier& PictureRectifier::operator=(PictureRectifier&&) noexcept = default;
PictureRectifier::~PictureRectifier() = default;

ImageRgb8 PictureRectifier::Rectified(const ImageRgb8& frame) const {
  LG_CHECK_EQ(frame.width, maps_->frame_at.cols);
  LG_CHECK_EQ(frame.height, maps_->frame_at.rows);
  ImageRgb8 out(frame.width, frame.height);
  cv::Mat target = MatOf(out);
  cv::remap(MatOf(frame), target, maps_->frame_at, maps_->frame_part, cv::INTER_CUBIC);
  return out;
}

ImageRgb8 PictureRectifier::WithChanges(const ImageRgb8& frame, const ImageRgb8& rectified,
                                        const ImageRgb8& changed) const {
  ImageRgb8 out = frame;
  cv::Mat difference, touched;
  cv::absdiff(MatOf(rectified), MatOf(changed), difference);
  cv::transform(difference, touched, cv::Matx13f(1, 1, 1));
  touched = touched > 0;
  cv::Mat share, bent;
  cv::remap(touched, share, maps_->rectified_at, maps_->rectified_part, cv::INTER_LINEAR);
  const cv::Rect box = cv::boundingRect(share);
  if (box.empty()) return out;
  cv::remap(MatOf(changed), bent, maps_->rectified_at(box), maps_->rectified_part(box),
            cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  for (int y = 0; y < box.height; ++y) {
    const std::uint8_t* weight = share.ptr(box.y + y, box.x);
    const std::uint8_t* from = bent.ptr(y);
    std::uint8_t* to = out.at(box.x, box.y + y);
    for (int x = 0; x < box.width; ++x, from += 3, to += 3) {
      const int w = weight[x];
      if (w == 0) continue;
      for (int c = 0; c < 3; ++c)
        to[c] = std::uint8_t((w * from[c] + (255 - w) * to[c] + 127) / 255);
    }
  }
  return out;
}

}  // namespace lorgnette
