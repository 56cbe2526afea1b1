// SPDX-License-Identifier: Apache-2.0
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>

#include "base/atomic_file.h"
#include "render/image_io.h"

namespace lorgnette {
namespace {

constexpr long kMostPixelsAByte = 4096;  // of the file; the tightest compression packs hundreds
constexpr float kHalfMax = 65504.0f;

// Whether each attribute of the headers lies within the file. OpenEXR would take the size that an
// attribute states for memory.
bool AttributesFit(const std::string& path, long bytes) {
  std::ifstream file(path, std::ios::binary);
  const auto number = [&] {
    unsigned char b[4] = {};
    file.read(reinterpret_cast<char*>(b), sizeof b);
    return long(b[0]) | long(b[1]) << 8 | long(b[2]) << 16 | long(b[3]) << 24;
  };
  file.seekg(4);
  const bool many_parts = Imf::isMultiPart(int(number()));
  do {
    std::string name, type;
    while (std::getline(file, name, '\0') && !name.empty() && std::getline(file, type, '\0')) {
      const long size = number(), at = long(file.tellg());
      if (!file || size > bytes - at) return false;
      file.seekg(at + size);
    }
  } while (many_parts && file && file.peek() > 0);
  return true;
}

template <int kChannels>
Result<Image<float, kChannels>> Read(const std::string& path) {
  try {
    const long bytes = long(std::filesystem::file_size(path));
    if (!AttributesFit(path, bytes)) {
      return Failure(path + ": not a readable EXR picture (a header that the file cuts off)");
    }
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    const long width = long(window.max.x) - window.min.x + 1;
    const long height = long(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
      return Failure(fmt::format("{}: got a data window of {}x{}, want sides of 1..{}", path, width,
                                 height, kMaxSide));
    }
    if (width * height / kMostPixelsAByte > bytes) {
      return Failure(
          fmt::format("{}: got {} bytes for {}x{} pixels, too few", path, bytes, width, height));
    }
    const Imf::ChannelList& channels = file.header().channels();
    const bool grey = !channels.findChannel("R") && channels.findChannel("Y");
    if (!grey) {
      for (const char* name : {"R", "G", "B"}) {
        if (!channels.findChannel(name)) {
          return Failure(fmt::format("{}: no channel {}, want R, G and B (or Y)", path, name));
        }
      }
    }
    Image<float, kChannels> image{int(width), int(height)};
    const std::size_t x_stride = sizeof(float) * kChannels;
    const std::size_t y_stride = x_stride * std::size_t(width);
    const char* names[4] = {"R", "G", "B", "A"};
    Imf::FrameBuffer buffer;
    for (int c = 0; c < kChannels; ++c) {
      const char* name = grey && c < 3 ? "Y" : names[c];
      if (grey && c > 0 && c < 3) continue;
      buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, image.data.data() + c, window, x_stride,
                                           y_stride, 1, 1, c == 3 ? 1.0 : 0.0));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    if (grey) {
      for (std::size_t i = 0; i < image.data.size(); i += kChannels) {
        image.data[i + 1] = image.data[i + 2] = image.data[i];
      }
    }
    return image;
  } catch (const std::exception& e) {
    return Failure(fmt::format("{}: not a readable EXR picture ({})", path, e.what()));
  }
}

template <int kChannels>
Status Write(const Image<float, kChannels>& image, const std::string& path, ExrDepth depth) {
  AtomicFile target(path);
  try {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    const char* names[4] = {"R", "G", "B", "A"};
    const Imf::PixelType type = depth == ExrDepth::kHalf ? Imf::HALF : Imf::FLOAT;
    std::vector<half> halves;
    if (depth == ExrDepth::kHalf) {
      halves.reserve(image.data.size());
      for (const float v : image.data) halves.push_back(half(std::clamp(v, -kHalfMax, kHalfMax)));
    }
    const std::size_t size = depth == ExrDepth::kHalf ? sizeof(half) : sizeof(float);
    char* const base = depth == ExrDepth::kHalf
                           ? reinterpret_cast<char*>(halves.data())
                           : reinterpret_cast<char*>(const_cast<float*>(image.data.data()));
    Imf::FrameBuffer buffer;
    for (int c = 0; c < kChannels; ++c) {
      header.channels().insert(names[c], Imf::Channel(type));
      buffer.insert(names[c], Imf::Slice(type, base + std::size_t(c) * size, size * kChannels,
                                         size * kChannels * std::size_t(image.width)));
    }
    Imf::OutputFile file(target.temporary_path().c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(image.height);
  } catch (const std::exception& e) {
    return Failure(fmt::format("{}: cannot write the picture ({})", path, e.what()));
  }
  return target.Commit();
}

}  // namespace

Result<ImageRgbF> ReadExr(const std::string& path) { return Read<3>(path); }
Result<ImageRgbaF> ReadExrRgba(const std::string& path) { return Read<4>(path); }

Status WriteExr(const ImageRgbF& image, const std::string& path, ExrDepth depth) {
  return Write<3>(image, path, depth);
}
Status WriteExr(const ImageRgbaF& image, const std::string& path, ExrDepth depth) {
  return Write<4>(image, path, depth);
}

Result<ImageRgbF> ReadHighDynamicRange(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Failure(fmt::format("{}: cannot be opened for reading", path));
  char head[4] = {};
  file.read(head, sizeof head);
  if (Imf::isImfMagic(head)) return ReadExr(path);
  if (head[0] == '#' && head[1] == '?') return ReadRadianceHdr(path);
  return Failure(fmt::format("{}: got neither an OpenEXR nor a Radiance HDR picture", path));
}

}  // namespace lorgnette
