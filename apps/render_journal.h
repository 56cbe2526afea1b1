// SPDX-License-Identifier: Apache-2.0
// What a long render has drawn so far, beside its output, so that it can be continued after it was
// killed: the pixels that differ from the input, frame by frame. A record that was cut short is
// dropped. The encoder sees the same frames in the end, and writes the same file.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/image.h"
#include "base/result.h"
#include "render/compositor.h"

namespace lorgnette {

// What the report counts of one frame.
struct FrameTally {
  RenderCounts counts;
  std::array<std::uint32_t, 3> effects{};  // by EffectRegion, one bit an Effect
};

class RenderJournal {
 public:
  // Opens the journal at `path`, or starts one. One of another `key` (what is drawn, and from what)
  // is started anew.
  static Result<RenderJournal> Open(const std::string& path, std::uint64_t key);

  long frames_kept() const { return long(records_.size()); }
  // Draws a frame that an earlier run has kept; nullopt when there is none.
  std::optional<FrameTally> Restore(long frame, ImageRgb8& picture) const;
  // Keeps a frame. `input` and `drawn` have one size.
  Status Keep(long frame, const ImageRgb8& input, const ImageRgb8& drawn, const FrameTally& tally);
  // The render is done: the file goes.
  void Remove();

 private:
  struct Header;
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  RenderJournal(std::string path, std::FILE* file) : path_(std::move(path)), file_(file) {}
  Status FindRecords();

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::map<long, long> records_;  // frame: place of its record in the file
};

// FNV-1a, for keys: of a text, and of what is at a path (its content up to 16 MiB, else size and
// time).
std::uint64_t HashOf(const std::string& text, std::uint64_t seed = 14695981039346656037u);
std::uint64_t HashOfFile(const std::string& path, std::uint64_t seed);

}  // namespace lorgnette
