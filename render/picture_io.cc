// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>

#include "base/atomic_file.h"
#include "render/image_io.h"

namespace lorgnette {

Result<ImageRgb8> ReadPicture(const std::string& path) {
  LG_ASSIGN(const std::string content, ReadFile(path));
  try {
    const cv::Mat bytes(1, int(content.size()), CV_8U, const_cast<char*>(content.data()));
    const cv::Mat bgr = content.empty() ? cv::Mat() : cv::imdecode(bytes, cv::IMREAD_COLOR);
    if (bgr.empty()) return Failure(fmt::format("{}: not a picture that can be decoded", path));
    ImageRgb8 image(bgr.cols, bgr.rows);
    for (int y = 0; y < bgr.rows; ++y) {
      const std::uint8_t* in = bgr.ptr(y);
      std::uint8_t* out = image.at(0, y);
      for (int x = 0; x < bgr.cols; ++x, in += 3, out += 3) {
        out[0] = in[2];
        out[1] = in[1];
        out[2] = in[0];
      }
    }
    return image;
  } catch (const cv::Exception& e) {
    return Failure(fmt::format("{}: not a picture that can be decoded ({})", path, e.err));
  }
}

Status WritePicture(const ImageRgb8& image, const std::string& path) {
  if (image.empty()) return Failure(fmt::format("{}: the picture has no pixels", path));
  const std::size_t dot = path.find_last_of('.');
  const std::string extension = dot == std::string::npos ? "" : path.substr(dot);
  if (extension != ".png" && extension != ".jpg" && extension != ".jpeg") {
    return UsageError(
        fmt::format("{}: got the extension `{}`, want .png, .jpg or .jpeg", path, extension));
  }
  std::vector<std::uint8_t> encoded;
  try {
    cv::Mat bgr(image.height, image.width, CV_8UC3);
    for (int y = 0; y < image.height; ++y) {
      const std::uint8_t* in = image.at(0, y);
      std::uint8_t* out = bgr.ptr(y);
      for (int x = 0; x < image.width; ++x, in += 3, out += 3) {
        out[0] = in[2];
        out[1] = in[1];
        out[2] = in[0];
      }
    }
    if (!cv::imencode(extension, bgr, encoded, {cv::IMWRITE_JPEG_QUALITY, 95})) {
      return Failure(fmt::format("{}: the picture cannot be encoded", path));
    }
  } catch (const cv::Exception& e) {
    return Failure(fmt::format("{}: the picture cannot be encoded ({})", path, e.err));
  }
  return WriteFileAtomically(
      path, std::string_view(reinterpret_cast<const char*>(encoded.data()), encoded.size()));
}

}  // namespace lorgnette
