// SPDX-License-Identifier: Apache-2.0
#include "geometry/texture_file.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>

namespace lorgnette {
namespace {
constexpr int kMostPixels = 8192;  // a side
}

Result<Texture> DecodeTexture(std::string_view bytes, const std::string& name) {
  tinygltf::Image image;
  std::string error, warning;
  if (bytes.empty() || bytes.size() > 256u << 20 ||
      !tinygltf::LoadImageData(&image, 0, &error, &warning, 0, 0,
                               reinterpret_cast<const unsigned char*>(bytes.data()),
                               int(bytes.size()), nullptr)) {
    return Failure(name + ": got no picture that can be read, want PNG, JPEG, BMP or TGA");
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
