// SPDX-License-Identifier: Apache-2.0
#include "render/exposure_tags.h"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "base/atomic_file.h"

namespace lorgnette {
namespace {

// A TIFF block in either byte order; reads beyond its end give 0.
class TiffBlock {
 public:
  explicit TiffBlock(std::string_view bytes)
      : bytes_(bytes),
        big_(bytes.substr(0, 2) == "MM"),
        valid_(big_ || bytes.substr(0, 2) == "II") {}
  bool valid() const { return valid_ && U16(2) == 42; }
  std::uint32_t U16(std::size_t at) const {
    return big_ ? Byte(at) << 8 | Byte(at + 1) : Byte(at + 1) << 8 | Byte(at);
  }
  std::uint32_t U32(std::size_t at) const {
    return big_ ? U16(at) << 16 | U16(at + 2) : U16(at + 2) << 16 | U16(at);
  }
  double Rational(std::size_t at) const {
    const double divisor = double(U32(at + 4));
    return divisor > 0 ? double(U32(at)) / divisor : 0;
  }

 private:
  std::uint32_t Byte(std::size_t at) const {
    return at < bytes_.size() ? std::uint8_t(bytes_[at]) : 0;
  }
  std::string_view bytes_;
  bool big_, valid_;
};

void ReadDirectory(const TiffBlock& tiff, std::size_t at, int depth, ExposureTags& tags) {
  constexpr std::uint32_t kTime = 0x829A, kFNumber = 0x829D, kIso = 0x8827, kExif = 0x8769;
  constexpr std::uint32_t kMostEntries = 512;
  const std::uint32_t entries = std::min(tiff.U16(at), kMostEntries);
  for (std::uint32_t i = 0; i < entries; ++i) {
    const std::size_t entry = at + 2 + 12 * std::size_t(i);
    const std::uint32_t tag = tiff.U16(entry);
    if (tag == kTime) tags.time_s = tiff.Rational(tiff.U32(entry + 8));
    if (tag == kFNumber && tiff.Rational(tiff.U32(entry + 8)) > 0) {
      tags.f_number = tiff.Rational(tiff.U32(entry + 8));
    }
    if (tag == kIso && tiff.U16(entry + 8) > 0) tags.iso = double(tiff.U16(entry + 8));
    if (tag == kExif && depth == 0) ReadDirectory(tiff, tiff.U32(entry + 8), 1, tags);
  }
}

}  // namespace

Result<std::optional<ExposureTags>> ReadExposureTags(const std::string& path) {
  const Result<std::string> content = ReadFile(path);
  if (!content) return tl::unexpected(content.error());
  const std::string_view bytes = *content;
  if (!bytes.starts_with("\xFF\xD8")) return std::optional<ExposureTags>();
  // Segments until the picture's data start.
  for (std::size_t at = 2; at + 4 <= bytes.size() && std::uint8_t(bytes[at]) == 0xFF;) {
    const std::uint8_t marker = std::uint8_t(bytes[at + 1]);
    const std::size_t length =
        std::size_t(std::uint8_t(bytes[at + 2])) << 8 | std::uint8_t(bytes[at + 3]);
    constexpr std::uint8_t kApp1 = 0xE1, kStartOfScan = 0xDA;
    if (marker == kStartOfScan || length < 2) break;
    const std::string_view body = bytes.substr(at + 4, length - 2);
    if (marker == kApp1 && body.substr(0, 6) == std::string_view("Exif\0\0", 6)) {
      const TiffBlock tiff(body.substr(6));
      if (!tiff.valid()) break;
      ExposureTags tags;
      ReadDirectory(tiff, tiff.U32(4), 0, tags);
      if (tags.time_s > 0) return std::optional<ExposureTags>(tags);
      break;
    }
    at += 2 + length;
  }
  return std::optional<ExposureTags>();
}

}  // namespace lorgnette
