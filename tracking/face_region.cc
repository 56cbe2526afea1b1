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

ImageRgb8 SampleRegion(const ImageRgb8& frame, const FaceRegion& region, int pixels) {
  const int oversample = std::clamp(int(std::lround(region.side / pixels)), 1, kMaxOversample);
  const int fine = pixels * oversample;
  // warpAffine counts from pixel centres: index i is position i + 0.5.
  const double step = region.side / fine;
  const double c = step * std::cos(region.angle), s = step * std::sin(region.angle);
  const Eigen::Vector2d corner =
      region.ToImage({0.5 / fine, 0.5 / fine}) - Eigen::Vector2d(0.5, 0.5);
  const cv::Matx23d source_from_sample(c, -s, corner.x(), s, c, corner.y());
  ImageRgb8 out(pixels, pixels);
  cv::Mat target = MatOf(out);
  const cv::Mat source = MatOf(frame);
  const int flags = cv::INTER_LINEAR | cv::WARP_INVERSE_MAP;
  if (oversample == 1) {
    cv::warpAffine(source, target, source_from_sample, target.size(), flags);
  } else {
    cv::Mat large;
    cv::warpAffine(source, large, source_from_sample, cv::Size(fine, fine), flags);
    cv::resize(large, target, target.size(), 0, 0, cv::INTER_AREA);
  }
  return out;
}

}  // namespace lorgnette
