// SPDX-License-Identifier: Apache-2.0
// Videos, image sequences (shot_%04d.png) and single images in; H.264 or image files out. Size,
// frame rate, time stamps, colour tags and sound of the input are kept.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/image.h"
#include "base/result.h"

namespace lorgnette {

struct VideoInfo {
  int width = 0, height = 0;
  double frame_rate = 25;  // average, frames a second
  long frame_count = 0;    // 0: unknown before reading
  bool has_audio = false;
  bool is_still = false;  // one image
};

// Display-encoded pixels as the file has them, full range RGB; linear light by LinearFromDisplay.
struct VideoFrame {
  ImageRgb8 rgb;
  double time_s = 0;
  long long pts = 0;  // in the stream's own time base, kept for the output
};

class VideoReader {
 public:
  static Result<VideoReader> Open(const std::string& path);
  VideoReader(VideoReader&&) noexcept;
  ~VideoReader();
  const VideoInfo& info() const;
  // nullopt at the end.
  Result<std::optional<VideoFrame>> Next();

 private:
  friend class VideoWriter;
  struct State;
  explicit VideoReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

class VideoWriter {
 public:
  // Takes time base, rate, colour tags, rotation and the sound streams from `source`.
  static Result<VideoWriter> Create(const std::string& path, const VideoReader& source);
  VideoWriter(VideoWriter&&) noexcept;
  ~VideoWriter();  // an unfinished file is removed
  Status Write(const VideoFrame& frame);
  Status Finish();  // the file appears under its name

 private:
  struct State;
  explicit VideoWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// sRGB transfer both ways, 8-bit code values and linear light; exact round trip of all 256 codes.
ImageRgbF LinearFromDisplay(const ImageRgb8& image);
ImageRgb8 DisplayFromLinear(const ImageRgbF& image);

}  // namespace lorgnette
