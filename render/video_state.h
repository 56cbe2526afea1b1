// SPDX-License-Identifier: Apache-2.0
// What a reader knows of its source, and the writer copies. Private to render/.
#pragma once

#include <string>
#include <vector>

#include "render/video_av.h"
#include "render/video_io.h"

namespace lorgnette {

struct VideoReader::State {
  std::string path;
  VideoReaderOptions options;
  VideoInfo info;

  // Image files in order; empty for a video.
  std::vector<std::string> images;
  std::size_t next_image = 0;
  int first_number = 1;  // of a sequence

  // A video's container and decoder.
  av::Input input;
  av::Codec decoder;
  int stream_index = -1;
  Orientation orientation;
  AVRational time_base{1, 25};
  AVRational frame_rate{25, 1};
  av::Packet packet;
  av::Scaler scaler;  // for pictures of scaler_format
  av::Frame planes;   // GBRP of the picture at hand; null where the scaler packs its pixels itself
  av::ColourReading reading;
  int scaler_format = AV_PIX_FMT_NONE;
  bool flushed = false;
  long frames_read = 0;
  long long last_pts = 0;

  AVStream* stream() const { return input->streams[stream_index]; }
  Result<std::optional<VideoFrame>> NextImage();
  Result<std::optional<VideoFrame>> NextFrame();
  Status ReadPacket();
  Status SetScaler(const AVFrame& frame);
  ImageRgb8 RgbOf(const AVFrame& frame) const;
  std::string Where() const;  // "at 3.20 s", for errors
};

}  // namespace lorgnette
