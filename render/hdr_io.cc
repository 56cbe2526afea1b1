// SPDX-License-Identifier: Apache-2.0
// Radiance RGBE pictures (G. Ward, "Real Pixels", Graphics Gems II; Radiance file formats).
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <sstream>
#include <string_view>

#include "base/atomic_file.h"
#include "render/image_io.h"

namespace lorgnette {
namespace {

struct Rgbe {
  std::uint8_t r = 0, g = 0, b = 0, e = 0;
};

// A cursor that never runs past the end: reads beyond it give 0 and set `overrun`.
struct Cursor {
  std::string_view bytes;
  std::size_t position = 0;
  bool overrun = false;
  std::uint8_t Next() {
    if (position >= bytes.size()) {
      overrun = true;
      return 0;
    }
    return std::uint8_t(bytes[position++]);
  }
};

bool ReadOldScanLine(Cursor& in, Rgbe first, std::vector<Rgbe>& line) {
  std::size_t x = 0;
  int shift = 0;
  Rgbe pixel = first;
  while (true) {
    if (pixel.r == 1 && pixel.g == 1 && pixel.b == 1) {
      const std::size_t run = std::size_t(pixel.e) << shift;
      if (x == 0 || x + run > line.size()) return false;
      for (std::size_t i = 0; i < run; ++i, ++x) line[x] = line[x - 1];
      shift += 8;
      if (shift > 24) return false;
    } else {
      line[x++] = pixel;
      shift = 0;
    }
    if (x == line.size()) return true;
    pixel = {in.Next(), in.Next(), in.Next(), in.Next()};
    if (in.overrun) return false;
  }
}

bool ReadChannel(Cursor& in, std::vector<Rgbe>& line, std::uint8_t Rgbe::*channel) {
  std::size_t x = 0;
  while (x < line.size()) {
    const int code = in.Next();
    const bool run = code > 128;
    const std::size_t count = std::size_t(run ? code - 128 : code);
    if (count == 0 || x + count > line.size() || in.overrun) return false;
    const std::uint8_t value = run ? in.Next() : std::uint8_t(0);
    for (std::size_t i = 0; i < count; ++i) line[x++].*channel = run ? value : in.Next();
  }
  return !in.overrun;
}

bool ReadScanLine(Cursor& in, std::vector<Rgbe>& line) {
  const Rgbe first{in.Next(), in.Next(), in.Next(), in.Next()};
  if (in.overrun) return false;
  const std::size_t coded_width = std::size_t(first.b) << 8 | first.e;
  if (first.r != 2 || first.g != 2 || first.b > 127 || coded_width != line.size()) {
    return ReadOldScanLine(in, first, line);
  }
  return ReadChannel(in, line, &Rgbe::r) && ReadChannel(in, line, &Rgbe::g) &&
         ReadChannel(in, line, &Rgbe::b) && ReadChannel(in, line, &Rgbe::e);
}

}  // namespace

Result<ImageRgbF> ReadRadianceHdr(const std::string& path) {
  LG_ASSIGN(const std::string content, ReadFile(path));
  Cursor in{content};
  const auto next_line = [&] {
    std::string line;
    while (in.position < content.size() && content[in.position] != '\n') {
      line += content[in.position++];
    }
    ++in.position;
    return line;
  };
  for (std::string line = next_line(); !line.empty(); line = next_line()) {
    if (line.starts_with("FORMAT=") && !line.starts_with("FORMAT=32-bit_rle_rgbe")) {
      return Failure(fmt::format("{}: got {}, want FORMAT=32-bit_rle_rgbe", path, line));
    }
  }
  const std::string resolution = next_line();
  std::istringstream words(resolution);
  std::string y_word, x_word;
  int height = 0, width = 0;
  words >> y_word >> height >> x_word >> width;
  if (y_word != "-Y" || x_word != "+X" || width < 1 || height < 1 || width > kMaxSide ||
      height > kMaxSide) {
    return Failure(fmt::format("{}: got the resolution line `{}`, want `-Y height +X width`", path,
                               resolution));
  }
  if (long(height) * 4 > long(content.size())) {  // a row takes a pixel's bytes at least
    return Failure(fmt::format("{}: got {} bytes for {} rows, the picture is cut short", path,
                               content.size(), height));
  }
  ImageRgbF image(width, height);
  std::vector<Rgbe> line(std::size_t(width), Rgbe{});
  for (int y = 0; y < height; ++y) {
    if (!ReadScanLine(in, line)) {
      return Failure(fmt::format("{}: the picture is cut short or broken in row {}", path, y));
    }
    float* out = image.at(0, y);
    for (const Rgbe& p : line) {
      const float scale = p.e == 0 ? 0.0f : std::ldexp(1.0f, int(p.e) - (128 + 8));
      *out++ = (float(p.r) + 0.5f) * scale;
      *out++ = (float(p.g) + 0.5f) * scale;
      *out++ = (float(p.b) + 0.5f) * scale;
    }
  }
  return image;
}

}  // namespace lorgnette
