// SPDX-License-Identifier: Apache-2.0
#include "tracking/patch_match.h"

#include <Eigen/LU>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/linear_algebra.h"
#include "tracking/opencv_view.h"

namespace lorgnette {
namespace {

constexpr double kSurroundingsSigma = 6;  // px of each level
constexpr double kNoiseLevels = 3;        // grey levels of deviation that count as nothing
constexpr double kSoften = 0.8;           // px, against the samples' own noise
constexpr int kMaxMatchSteps = 12;
constexpr double kMatchSettled_px = 0.02;  // px
constexpr double kMinStrength = 0.004;     // per px^2, of values of about unit deviation

Image<float, 1> Normalised(const cv::Mat& grey) {
  cv::Mat image, mean, deviation;
  grey.convertTo(image, CV_32F);
  cv::GaussianBlur(image, image, cv::Size(), kSoften);
  const cv::Size window(4 * int(kSurroundingsSigma / 2) + 1, 4 * int(kSurroundingsSigma / 2) + 1);
  cv::boxFilter(image, mean, -1, window);
  image -= mean;
  cv::boxFilter(image.mul(image), deviation, -1, window);
  cv::sqrt(deviation + kNoiseLevels * kNoiseLevels, deviation);
  Image<float, 1> out(grey.cols, grey.rows);
  cv::Mat target(out.height, out.width, CV_32F, out.data.data());
  cv::divide(image, deviation, target);
  return out;
}

bool Inside(const Image<float, 1>& image, double x, double y) {
  return x >= 0 && y >= 0 && x < image.width - 1 && y < image.height - 1;
}

// Value at index coordinates; the caller keeps them inside.
float Bilinear(const Image<float, 1>& image, float x, float y) {
  const int ix = int(x), iy = int(y);
  const float fx = x - float(ix), fy = y - float(iy);
  const float* row = image.at(ix, iy);
  const float* next = row + image.width;
  return (row[0] * (1 - fx) + row[1] * fx) * (1 - fy) + (next[0] * (1 - fx) + next[1] * fx) * fy;
}

}  // namespace

TexturePyramid::TexturePyramid(const Image<std::uint8_t, 1>& grey) {
  cv::Mat level = MatOf(grey);
  for (Image<float, 1>& out : levels) {
    out = Normalised(level);
    cv::Mat half;
    cv::resize(level, half, cv::Size(level.cols / 2, level.rows / 2), 0, 0, cv::INTER_AREA);
    level = half;
  }
}

std::optional<PatchTemplate> PatchTemplate::Cut(const Image<float, 1>& level,
                                                const Eigen::Vector2d& centre) {
  const double reach = kRadius + 1;
  const double at_x = centre.x() - 0.5, at_y = centre.y() - 0.5;
  const float cx = float(at_x), cy = float(at_y);
  if (!Inside(level, at_x - reach, at_y - reach) || !Inside(level, at_x + reach, at_y + reach)) {
    return std::nullopt;
  }
  PatchTemplate patch;
  patch.structure_.setZero();
  int k = 0;
  for (int y = -kRadius; y <= kRadius; y += kStep) {
    for (int x = -kRadius; x <= kRadius; x += kStep, ++k) {
      const auto i = std::size_t(k);
      const float px = cx + float(x), py = cy + float(y);
      patch.value_[i] = Bilinear(level, px, py);
      patch.dx_[i] = (Bilinear(level, px + 1, py) - Bilinear(level, px - 1, py)) / 2;
      patch.dy_[i] = (Bilinear(level, px, py + 1) - Bilinear(level, px, py - 1)) / 2;
      const Eigen::Vector2d gradient(double(patch.dx_[i]), double(patch.dy_[i]));
      patch.structure_ += gradient * gradient.transpose();
    }
  }
  patch.strength_ = SymmetricEigenvalues(patch.structure_)[0] / kSamples;
  if (patch.strength_ < kMinStrength) return std::nullopt;
  return patch;
}

std::optional<PatchTemplate::Match> PatchTemplate::Find(const Image<float, 1>& level,
                                                        const Eigen::Vector2d& guess,
                                                        const Eigen::Matrix2d& other_from_patch,
                                                        double reach_px) const {
  if (std::abs(other_from_patch.determinant()) < 0.1) return std::nullopt;
  // In the patch's own pixels the step solves structure * step = sum gradient * difference.
  const Eigen::Matrix2d inverse = structure_.inverse();
  Eigen::Vector2d position = guess;
  std::array<float, kSamples> seen;
  bool settled = false;
  for (int step = 0; step < kMaxMatchSteps && !settled; ++step) {
    const Eigen::Matrix2d& m = other_from_patch;
    const double extent = kRadius * (m.cwiseAbs() * Eigen::Vector2d::Ones()).maxCoeff() + 1;
    const double cx = position.x() - 0.5, cy = position.y() - 0.5;
    if (!Inside(level, cx - extent, cy - extent) || !Inside(level, cx + extent, cy + extent)) {
      return std::nullopt;
    }
    float sum_x = 0, sum_y = 0;
    int k = 0;
    const float step_x = float(kStep * m(0, 0)), step_y = float(kStep * m(1, 0));
    for (int y = -kRadius; y <= kRadius; y += kStep) {
      float px = float(cx + m(0, 1) * y - m(0, 0) * kRadius);
      float py = float(cy + m(1, 1) * y - m(1, 0) * kRadius);
      for (int x = 0; x < kSide; ++x, ++k, px += step_x, py += step_y) {
        const auto i = std::size_t(k);
        seen[i] = Bilinear(level, px, py);
        const float difference = value_[i] - seen[i];
        sum_x += dx_[i] * difference;
        sum_y += dy_[i] * difference;
      }
    }
    const Eigen::Vector2d move = m * (inverse * Eigen::Vector2d(double(sum_x), double(sum_y)));
    position += move;
    settled = move.norm() < kMatchSettled_px;
    if ((position - guess).norm() > reach_px) return std::nullopt;
  }
  if (!settled) return std::nullopt;
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    a += double(value_[i]);
    b += double(seen[i]);
    aa += double(value_[i] * value_[i]);
    bb += double(seen[i] * seen[i]);
    ab += double(value_[i] * seen[i]);
  }
  const double spread = (aa - a * a / kSamples) * (bb - b * b / kSamples);
  if (!(spread > 0)) return std::nullopt;
  return Match{position, (ab - a * b / kSamples) / std::sqrt(spread)};
}

}  // namespace lorgnette
