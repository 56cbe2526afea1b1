// SPDX-License-Identifier: Apache-2.0
// The picture that glasses are put into, as linear light: given so, or display-encoded and decoded
// where rays read it, since most of a video's pixels are never read. Internal to render/.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>

#include "base/image.h"
#include "render/color.h"

namespace lorgnette {

// Columns x0..x1-1 and rows y0..y1-1.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
};
inline PixelBox Grown(const PixelBox& b, int by) {
  return b.empty() ? b : PixelBox{b.x0 - by, b.y0 - by, b.x1 + by, b.y1 + by};
}
inline PixelBox Clipped(const PixelBox& b, int width, int height) {
  return {std::max(b.x0, 0), std::max(b.y0, 0), std::min(b.x1, width), std::min(b.y1, height)};
}

// Refers to the image, which has to outlive it; copies share what was decoded. Thread safe.
class InputPicture {
 public:
  InputPicture(const ImageRgbF& linear);   // NOLINT(google-explicit-constructor)
  InputPicture(const ImageRgb8& display);  // NOLINT(google-explicit-constructor): none decoded yet
  // Decodes `ready` at once, for fast reading. The values are those of LinearFromDisplay.
  InputPicture(const ImageRgb8& display, const PixelBox& ready);

  int width() const { return width_; }
  int height() const { return height_; }
  const ImageRgb8* display() const { return display_; }

  // Whether a block of pixels can be read at Ready(x, y), rows of stride() floats apart.
  bool IsReady(int x0, int y0, int x1, int y1) const {
    return x0 >= ready_.x0 && y0 >= ready_.y0 && x1 <= ready_.x1 && y1 <= ready_.y1;
  }
  const float* Ready(int x, int y) const {
    return pixels_ + std::size_t(y - ready_.y0) * stride_ + std::size_t(x - ready_.x0) * 3;
  }
  std::size_t stride() const { return stride_; }
  // Any pixel inside the picture.
  Eigen::Vector3f Pixel(int x, int y) const {
    if (IsReady(x, y, x + 1, y + 1)) return Eigen::Map<const Eigen::Vector3f>(Ready(x, y));
    Eigen::Vector3f light;
    LinearFromCodes(display_->at(x, y), 3, light.data());
    return light;
  }
  // The greatest value of each channel.
  Eigen::Vector3f Brightest() const;

 private:
  int width_, height_;
  const ImageRgb8* display_ = nullptr;
  PixelBox ready_;
  std::size_t stride_ = 0;
  const float* pixels_ = nullptr;
  std::shared_ptr<float[]> decoded_;
};

}  // namespace lorgnette
