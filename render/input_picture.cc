// SPDX-License-Identifier: Apache-2.0
#include "render/input_picture.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "render/color.h"

namespace lorgnette {

InputPicture::InputPicture(const ImageRgbF& linear)
    : width_(linear.width),
      height_(linear.height),
      ready_{0, 0, linear.width, linear.height},
      stride_(std::size_t(linear.width) * 3),
      pixels_(linear.data.data()) {}

InputPicture::InputPicture(const ImageRgb8& display)
    : width_(display.width), height_(display.height), display_(&display) {}

InputPicture::InputPicture(const ImageRgb8& display, const PixelBox& ready)
    : InputPicture(display) {
  ready_ = {std::max(ready.x0, 0), std::max(ready.y0, 0), std::min(ready.x1, width_),
            std::min(ready.y1, height_)};
  if (ready_.empty()) {
    ready_ = {};
    return;
  }
  stride_ = std::size_t(ready_.x1 - ready_.x0) * 3;
  const std::size_t rows = std::size_t(ready_.y1 - ready_.y0);
  decoded_.reset(new float[stride_ * rows]);
  pixels_ = decoded_.get();
  constexpr std::size_t kRowsATask = 16;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows, kRowsATask),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t row = range.begin(); row < range.end(); ++row) {
                        LinearFromCodes(display.at(ready_.x0, ready_.y0 + int(row)), stride_,
                                        decoded_.get() + row * stride_);
                      }
                    });
}

Eigen::Vector3f InputPicture::Brightest() const {
  if (display_ == nullptr) {
    Eigen::Vector3f most = Eigen::Vector3f::Zero();
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) most = most.cwiseMax(Pixel(x, y));
    }
    return most;
  }
  // Side by side, as compilers like it (std::max, by reference, is a jump to them): sixteen pixels
  // at a time, then what is left.
  constexpr std::size_t kRun = 48;
  std::uint8_t lanes[kRun] = {};
  const std::uint8_t* codes = display_->data.data();
  const std::size_t size = display_->data.size();
  const auto greater = [](std::uint8_t a, std::uint8_t b) { return a > b ? a : b; };
  std::size_t i = 0;
  for (; i + kRun <= size; i += kRun) {
    for (std::size_t k = 0; k < kRun; ++k) lanes[k] = greater(lanes[k], codes[i + k]);
  }
  for (std::size_t k = 0; i + k < size; ++k) lanes[k] = greater(lanes[k], codes[i + k]);
  std::uint8_t most[3] = {0, 0, 0};
  for (std::size_t k = 0; k < kRun; ++k) most[k % 3] = std::max(most[k % 3], lanes[k]);
  return {LinearFromCode(most[0]), LinearFromCode(most[1]), LinearFromCode(most[2])};
}

}  // namespace lorgnette
