// SPDX-License-Identifier: Apache-2.0
// Pixel buffers shared by tracking and rendering. Rows run downwards from the top; the centre of
// pixel (column, row) lies at (column + 0.5, row + 0.5).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lorgnette {

// Interleaved image without padding: pixel (x, y) starts at data[(y * width + x) * kChannels].
template <typename T, int kChannels>
struct Image {
  static constexpr int channels = kChannels;
  int width = 0;
  int height = 0;
  std::vector<T> data;

  Image() = default;
  Image(int w, int h) : width(w), height(h), data(std::size_t(w) * std::size_t(h) * kChannels) {}
  bool empty() const { return data.empty(); }
  T* at(int x, int y) { return data.data() + Offset(x, y); }
  const T* at(int x, int y) const { return data.data() + Offset(x, y); }

 private:
  std::size_t Offset(int x, int y) const {
    return (std::size_t(y) * std::size_t(width) + std::size_t(x)) * kChannels;
  }
};

using ImageRgb8 = Image<std::uint8_t, 3>;  // display-encoded (sRGB or BT.709 as the source says)
using ImageRgbF = Image<float, 3>;         // linear light, Rec.709 primaries
using ImageRgbaF = Image<float, 4>;        // linear light, premultiplied alpha

}  // namespace lorgnette
