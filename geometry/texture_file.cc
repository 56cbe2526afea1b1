// SPDX-License-Identifier: Apache-2.0
#include "geometry/texture_file.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>

namespace lorgnette {
namespace {

constexpr int kMostPixels = 8192;  // a side

}  // namespace

// Whether each chunk of a PNG lies within the file (PNG specification, 5.3), and its sides within
// what we read. The decoder would take the length that a chunk states, and the width and height of
// the first one, for memory and time. Other formats pass.
bool PictureFits(std::string_view bytes) {
  constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
  if (!bytes.starts_with(kSignature)) return true;
  constexpr std::size_t kAround = 12;  // length, type, check sum
  const auto number = [&](std::size_t from) {
    std::size_t value = 0;
    for (std::size_t k = from; k < from + 4; ++k) {
      value = value << 8 | static_cast<unsigned char>(bytes[k]);
    }
    return value;
  };
  std::size_t at = kSignature.size();
  while (bytes.size() - at >= kAround) {
    const std::size_t length = number(at);
    if (length > bytes.size() - at - kAround) return false;
    const std::string_view type = bytes.substr(at + 4, 4);
    if (type == "IEND") return true;
    if (type == "IHDR" && length >= 8 &&
        std::max(number(at + 8), number(at + 12)) > std::size_t(kMostPixels)) {
      return false;
    }
    at += kAround + length;
  }
  return true;
}

Result<Texture> DecodeTexture(std::string_view bytes, const std::string& name) {
  tinygltf::Image image;
  std::string error, warning;
  if (bytes.empty() || bytes.size() > 256u << 20 || !PictureFits(bytes) ||
      !tinygltf::LoadImageData(&image, 0, &error, &warning, 0, 0,
                               reinterpret_cast<const unsigned char*>(bytes.data()),
                               int(bytes.size()), nullptr)) {
    return Failure(
        fmt::format("{}: got no picture that can be read, want PNG, JPEG, BMP or TGA of {} pixels "
                    "a side at most",
                    name, kMostPixels));
  }
  if (image.width > kMostPixels || image.height > kMostPixels) {
    return Failure(fmt::format("{}: got a picture of {}x{} pixels, want {} a side at most", name,
                               image.width, image.height, kMostPixels));
  }
  // Four channels of 8 or 16 bits, the high byte second.
  const std::size_t step = image.bits == 16 ? 2 : 1;
  Texture texture;
  texture.image = ImageRgba8(image.width, image.height);
  if (image.component != 4 || image.image.size() < texture.image.data.size() * step) {
    return Failure(name + ": got a picture of an unknown layout, want PNG, JPEG, BMP or TGA");
  }
  for (std::size_t i = 0; i < texture.image.data.size(); ++i) {
    texture.image.data[i] = image.image[i * step + step - 1];
  }
  return texture;
}

}  // namespace lorgnette
