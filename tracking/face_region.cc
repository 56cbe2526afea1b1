// SPDX-License-Identifier: Apache-2.0
#include "tracking/face_region.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tracking/opencv_view.h"

namespace lorgnette {
namespace {

constexpr double kMargin = 1.5;    // region side over the face's extent
constexpr int kMaxOversample = 4;  // samples a network pixel and axis

}  // namespace

Eigen::Vector2d FaceRegion::ToImage(const Eigen::Vector2d& uv) const {
  const Eigen::Vector2d offset = side * (uv - Eigen::Vector2d(0.5, 0.5));
  return centre + Eigen::Rotation2Dd(angle) * offset;
}

Eigen::Vector2d FaceRegion::FromImage(const Eigen::Vector2d& px) const {
  const Eigen::Vector2d turned = Eigen::Rotation2Dd(-angle) * (px - centre);
  return turned / side + Eigen::Vector2d(0.5, 0.5);
}

FaceRegion RegionAround(const std::vector<Eigen::Vector2d>& points,
                        const Eigen::Vector2d& right_eye, const Eigen::Vector2d& left_eye) {
  const Eigen::Vector2d eyes = left_eye - right_eye;
  FaceRegion region;
  region.angle = std::atan2(eyes.y(), eyes.x());
  const Eigen::Rotation2Dd upright(-region.angle);
  Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Array2d q = (upright * p).array();
    low = low.min(q);
    high = high.max(q);
  }
  region.centre = upright.inverse() * Eigen::Vector2d((low + high).matrix() / 2);
  region.side = kMargin * (high - low).maxCoeff();
  return region;
}

namespace {

// The part of the frame that the region covers, with room for interpolation.
cv::Rect BoxOf(const FaceRegion& region, const cv::Size& frame) {
  constexpr double kRoom = 4;
  const double half =
      region.side / 2 * (std::abs(std::cos(region.angle)) + std::abs(std::sin(region.angle)));
  const auto at = [&](double centre, double sign) {
    // Far outside is outside; the numbers stay in range.
    return int(std::clamp(std::floor(centre + sign * (half + kRoom)), -1e6, 1e6));
  };
  const cv::Point low(at(region.centre.x(), -1), at(region.centre.y(), -1));
  const cv::Point high(at(region.centre.x(), 1) + 1, at(region.centre.y(), 1) + 1);
  return cv::Rect(low, high) & cv::Rect(cv::Point(0, 0), frame);
}

void Sample(const cv::Mat& frame, const FaceRegion& region, cv::Mat& target, bool grey) {
  const int pixels = target.cols;
  cv::Rect box = BoxOf(region, frame.size());
  if (box.width < 2 || box.height < 2) {
    target.setTo(0);
    return;
  }
  cv::Mat source = frame(box);
  if (grey) cv::cvtColor(source, source, cv::COLOR_RGB2GRAY);
  // Halving by area is cheap and leaves less to interpolate.
  double zoom = 1;
  if (region.side > 2 * pixels) {
    box.width &= ~1;
    box.height &= ~1;
    cv::Mat half;
    cv::resize(source(cv::Rect(0, 0, box.width, box.height)), half,
               cv::Size(box.width / 2, box.height / 2), 0, 0, cv::INTER_AREA);
    source = half;
    zoom = 0.5;
  }
  const double side = zoom * region.side;
  const int oversample = std::clamp(int(std::lround(side / pixels)), 1, kMaxOversample);
  const int fine = pixels * oversample;
  // warpAffine counts from pixel centres: index i is position i + 0.5.
  const double step = side / fine;
  const double c = step * std::cos(region.angle), s = step * std::sin(region.angle);
  const Eigen::Vector2d corner =
      zoom * (region.ToImage({0.5 / fine, 0.5 / fine}) - Eigen::Vector2d(box.x, box.y)) -
      Eigen::Vector2d(0.5, 0.5);
  const cv::Matx23d source_from_sample(c, -s, corner.x(), s, c, corner.y());
  const int flags = cv::INTER_LINEAR | cv::WARP_INVERSE_MAP;
  if (oversample == 1) {
    cv::warpAffine(source, target, source_from_sample, target.size(), flags);
  } else {
    cv::Mat large;
    cv::warpAffine(source, large, source_from_sample, cv::Size(fine, fine), flags);
    cv::resize(large, target, target.size(), 0, 0, cv::INTER_AREA);
  }
}

}  // namespace

ImageRgb8 SampleRegion(const ImageRgb8& frame, const FaceRegion& region, int pixels) {
  ImageRgb8 out(pixels, pixels);
  cv::Mat target = MatOf(out);
  Sample(MatOf(frame), region, target, false);
  return out;
}

Image<std::uint8_t, 1> SampleGrey(const ImageRgb8& frame, const FaceRegion& region, int pixels) {
  Image<std::uint8_t, 1> out(pixels, pixels);
  cv::Mat target = MatOf(out);
  Sample(MatOf(frame), region, target, true);
  return out;
}

}  // namespace lorgnette
