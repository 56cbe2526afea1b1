// SPDX-License-Identifier: Apache-2.0
#include "apps/render_journal.h"

#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "base/atomic_file.h"
#include "base/check.h"

namespace lorgnette {
namespace {

constexpr char kMagic[8] = {'L', 'G', 'J', 'R', 'N', 'L', '0', '1'};

struct FileHeader {
  char magic[8];
  std::uint64_t key;
};

// Bounds of the pixels that differ: x0, y0, width, height.
using JournalBox = std::array<std::int32_t, 4>;
JournalBox Changed(const ImageRgb8& a, const ImageRgb8& b) {
  int x0 = a.width, y0 = a.height, x1 = -1, y1 = -1;
  for (int y = 0; y < a.height; ++y) {
    const std::uint8_t *p = a.at(0, y), *q = b.at(0, y);
    const int row = 3 * a.width;
    const int first = int(std::mismatch(p, p + row, q).first - p);
    if (first == row) continue;
    int last = row - 1;
    while (p[last] == q[last]) --last;
    x0 = std::min(x0, first / 3);
    x1 = std::max(x1, last / 3);
    y0 = std::min(y0, y);
    y1 = y;
  }
  if (x1 < 0) return {0, 0, 0, 0};
  return {x0, y0, x1 - x0 + 1, y1 - y0 + 1};
}

}  // namespace

// Stands before each record's compressed bytes.
struct RenderJournal::Header {
  std::int64_t frame;
  JournalBox box;
  std::int64_t lens, frame_pixels, shadowed, filled;
  std::uint32_t effects[3];
  std::uint32_t bytes, check;  // of the compressed difference; CRC-32 of it
  std::uint32_t own_check;     // CRC-32 of the header up to here

  std::uint32_t OwnCheck() const {
    return std::uint32_t(
        crc32(0, reinterpret_cast<const Bytef*>(this), uInt(offsetof(Header, own_check))));
  }
};

Result<RenderJournal> RenderJournal::Open(const std::string& path, std::uint64_t key) {
  std::FILE* file = std::fopen(path.c_str(), "r+b");
  if (file != nullptr) {
    FileHeader header{};
    const bool ours = std::fread(&header, sizeof header, 1, file) == 1 &&
                      std::memcmp(header.magic, kMagic, sizeof kMagic) == 0 && header.key == key;
    if (ours) {
      RenderJournal journal(path, file);
      LG_RETURN_IF_ERROR(journal.FindRecords());
      return journal;
    }
    std::fclose(file);
  }
  file = std::fopen(path.c_str(), "w+b");
  if (file == nullptr) {
    return Failure(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  }
  RenderJournal journal(path, file);
  FileHeader header{};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.key = key;
  if (std::fwrite(&header, sizeof header, 1, file) != 1 || std::fflush(file) != 0) {
    return Failure(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  }
  return journal;
}

Status RenderJournal::FindRecords() {
  std::FILE* file = file_.get();
  long end = std::ftell(file);
  std::vector<std::uint8_t> bytes;
  while (true) {
    Header header{};
    if (std::fread(&header, sizeof header, 1, file) != 1 || header.OwnCheck() != header.own_check) {
      break;
    }
    bytes.resize(header.bytes);
    if (std::fread(bytes.data(), 1, bytes.size(), file) != bytes.size() ||
        crc32(0, bytes.data(), uInt(bytes.size())) != header.check) {
      break;
    }
    records_[long(header.frame)] = end;
    end = std::ftell(file);
  }
  // What comes after was cut short.
  if (std::fflush(file) != 0 || ftruncate(fileno(file), end) != 0 ||
      std::fseek(file, end, SEEK_SET) != 0) {
    return Failure(fmt::format("{}: cannot be written: {}", path_, std::strerror(errno)));
  }
  return {};
}

std::optional<FrameTally> RenderJournal::Restore(long frame, ImageRgb8& picture) const {
  const auto found = records_.find(frame);
  if (found == records_.end()) return std::nullopt;
  std::FILE* file = file_.get();
  Header header{};
  if (std::fseek(file, found->second, SEEK_SET) != 0 ||
      std::fread(&header, sizeof header, 1, file) != 1) {
    return std::nullopt;
  }
  const auto [x0, y0, width, height] = header.box;
  if (x0 < 0 || y0 < 0 || width < 0 || height < 0 || width > picture.width - x0 ||
      height > picture.height - y0) {
    return std::nullopt;
  }
  std::vector<std::uint8_t> packed(header.bytes);
  const std::size_t row = 3 * std::size_t(width);
  std::vector<std::uint8_t> plain(row * std::size_t(height));
  uLongf size = uLongf(plain.size());
  if (std::fread(packed.data(), 1, packed.size(), file) != packed.size() ||
      (!plain.empty() && (uncompress(plain.data(), &size, packed.data(), packed.size()) != Z_OK ||
                          size != plain.size()))) {
    return std::nullopt;
  }
  for (int y = 0; y < height; ++y) {
    std::uint8_t* out = picture.at(x0, y0 + y);
    const std::uint8_t* change = plain.data() + std::size_t(y) * row;
    for (std::size_t i = 0; i < row; ++i) out[i] = std::uint8_t(out[i] ^ change[i]);
  }
  FrameTally tally;
  tally.counts = {long(header.lens), long(header.frame_pixels), long(header.shadowed),
                  long(header.filled)};
  std::copy_n(header.effects, 3, tally.effects.begin());
  return tally;
}

Status RenderJournal::Keep(long frame, const ImageRgb8& input, const ImageRgb8& drawn,
                           const FrameTally& tally) {
  LG_CHECK_EQ(input.width, drawn.width);
  LG_CHECK_EQ(input.height, drawn.height);
  Header header{};
  header.frame = frame;
  header.box = Changed(input, drawn);
  header.lens = tally.counts.lens_pixels;
  header.frame_pixels = tally.counts.frame_pixels;
  header.shadowed = tally.counts.shadowed_pixels;
  header.filled = tally.counts.filled_samples;
  std::copy_n(tally.effects.begin(), 3, header.effects);
  const auto [x0, y0, width, height] = header.box;
  std::vector<std::uint8_t> plain;
  plain.reserve(3 * std::size_t(width) * std::size_t(height));
  for (int y = 0; y < height; ++y) {
    const std::uint8_t *a = input.at(x0, y0 + y), *b = drawn.at(x0, y0 + y);
    for (int i = 0; i < 3 * width; ++i) plain.push_back(std::uint8_t(a[i] ^ b[i]));
  }
  uLongf size = compressBound(uLong(plain.size()));
  std::vector<std::uint8_t> packed(size);
  constexpr int kFast = 1;
  if (compress2(packed.data(), &size, plain.data(), uLong(plain.size()), kFast) != Z_OK) {
    return Failure(path_ + ": a frame cannot be compressed");
  }
  header.bytes = std::uint32_t(size);
  header.check = std::uint32_t(crc32(0, packed.data(), uInt(size)));
  header.own_check = header.OwnCheck();
  std::FILE* file = file_.get();
  const long place = std::fseek(file, 0, SEEK_END) == 0 ? std::ftell(file) : -1;
  if (place < 0 || std::fwrite(&header, sizeof header, 1, file) != 1 ||
      std::fwrite(packed.data(), 1, size, file) != size || std::fflush(file) != 0) {
    return Failure(fmt::format("{}: cannot be written: {}", path_, std::strerror(errno)));
  }
  records_[frame] = place;
  return {};
}

void RenderJournal::Remove() {
  file_.reset();
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

std::uint64_t HashOf(const std::string& text, std::uint64_t seed) {
  for (const char c : text) seed = (seed ^ std::uint8_t(c)) * 1099511628211u;
  return seed;
}

std::uint64_t HashOfFile(const std::string& path, std::uint64_t seed) {
  constexpr std::uintmax_t kWhole = 16u << 20;
  std::error_code failed;
  const auto size = std::filesystem::file_size(path, failed);
  if (failed) return HashOf(path, seed);
  seed = HashOf(std::to_string(size), seed);
  if (size <= kWhole) {
    if (const auto content = ReadFile(path)) return HashOf(*content, seed);
  }
  const auto time = std::filesystem::last_write_time(path, failed);
  return HashOf(std::to_string(time.time_since_epoch().count()), seed);
}

}  // namespace lorgnette
