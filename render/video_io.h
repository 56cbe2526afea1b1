// SPDX-License-Identifier: Apache-2.0
// Videos, image sequences (shot_%04d.png) and single images in; H.264 or image files out. Size,
// frame rate, time stamps, colour tags, rotation and sound of the input are kept.
//
// Colour: YUV becomes RGB by the matrix and range that the stream names. Where it names none, sizes
// above 1024x576 are taken as BT.709 and smaller ones as BT.601, limited range, as players do; the
// output then names none either. Transfer: see render/color.h (sRGB; PQ and HLG are not decoded).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/image.h"
#include "base/result.h"
#include "render/color.h"

namespace lorgnette {

struct VideoInfo {
  int width = 0, height = 0;  // upright, after the rotation that the file asks for
  double frame_rate = 25;     // average, frames a second; image sequences: 25
  long frame_count = 0;       // by the container's word; 0: unknown before reading
  bool has_audio = false;
  bool is_still = false;  // one image
};

// A frame as decoded, before RGB (render/video_av.h).
struct DecodedPicture;

// Display-encoded pixels, full range RGB, upright; linear light by LinearFromDisplay.
struct VideoFrame {
  ImageRgb8 rgb;
  double time_s = 0;
  long long pts = 0;  // in the stream's own time base, kept for the output
  // Lets the writer store pixels whose rgb nobody changed exactly as they were decoded. None for
  // image files.
  std::shared_ptr<const DecodedPicture> original;
};

struct VideoReaderOptions {
  // Frames come with VideoFrame::original; whoever writes no video does without.
  bool keep_originals = true;
  // false: chroma is taken from the nearest sample, in a fifth of the time; for those who look for
  // shapes in a picture that nobody will see. Only for YUV 4:2:0 and 4:2:2 of 8 bits whose width
  // is a multiple of 16.
  bool exact_colours = true;
};

class VideoReader {
 public:
  // Videos by any name; "shot_%04d.png" is a sequence from its lowest number on, without gaps;
  // .png .jpg .jpeg .bmp .tif .tiff .webp are single images.
  static Result<VideoReader> Open(const std::string& path, const VideoReaderOptions& options = {});
  VideoReader(VideoReader&&) noexcept;
  VideoReader& operator=(VideoReader&&) noexcept;
  ~VideoReader();
  const VideoInfo& info() const;
  const std::string& path() const;
  // nullopt at the end. A broken file is an error that names the time reached, and so is a cut one
  // whose container tells (.mp4 and .mov do; .mkv just ends).
  Result<std::optional<VideoFrame>> Next();

 private:
  friend class VideoWriter;
  struct State;
  explicit VideoReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

struct VideoWriterOptions {
  // For a part of a clip: the first frame written gets time 0, and the sound is cut to the part.
  bool start_at_first_frame = false;
  // H.264 constant rate factor; 16 keeps untouched pixels within about one code value.
  double crf = 16;
};

class VideoWriter {
 public:
  // Takes time base, rate, colour tags, rotation and the sound streams from `source`. The name
  // chooses the form: .mp4 .mov .m4v .mkv, a sequence (out_%04d.png or .jpg), or one .png or .jpg
  // when the source is one image.
  static Result<VideoWriter> Create(const std::string& path, const VideoReader& source,
                                    const VideoWriterOptions& options = {});
  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;
  ~VideoWriter();  // an unfinished file is removed
  Status Write(const VideoFrame& frame);
  Status Finish();  // the file appears under its name

 private:
  struct State;
  explicit VideoWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lorgnette
