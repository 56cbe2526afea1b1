// SPDX-License-Identifier: Apache-2.0
// Pictures on disk: OpenEXR and Radiance HDR in linear light, PNG and JPEG as 8-bit code values.
//
// Every function says which file failed and why; nothing half-written is left behind.
#pragma once

#include <string>

#include "base/image.h"
#include "base/result.h"

namespace lorgnette {

enum class ExrDepth { kHalf, kFloat };

// A longer side of a picture in linear light is a broken or hostile file.
inline constexpr int kMaxSide = 1 << 16;

// EXR with channels R, G, B (or Y alone, copied to all three). The picture covers the file's data
// window; pixels are as stored, NaN included.
Result<ImageRgbF> ReadExr(const std::string& path);
// The same with channel A; 1 where the file has none.
Result<ImageRgbaF> ReadExrRgba(const std::string& path);

// ZIP-compressed scan lines, data window from (0, 0). Values past the half range are clamped to
// +-65504 when depth is kHalf.
Status WriteExr(const ImageRgbF& image, const std::string& path, ExrDepth depth = ExrDepth::kHalf);
Status WriteExr(const ImageRgbaF& image, const std::string& path, ExrDepth depth);

// Radiance RGBE (.hdr, .pic), old and new run-length coding, -Y +X orientation.
Result<ImageRgbF> ReadRadianceHdr(const std::string& path);

// By content: EXR or Radiance HDR; other files are an error that names both.
Result<ImageRgbF> ReadHighDynamicRange(const std::string& path);

// PNG, JPEG, BMP, TIFF or WebP by content, to 8 bits, upright as EXIF says; grey becomes RGB, alpha
// is dropped.
Result<ImageRgb8> ReadPicture(const std::string& path);
// PNG, or JPEG of high quality, by the name's extension.
Status WritePicture(const ImageRgb8& image, const std::string& path);

}  // namespace lorgnette
