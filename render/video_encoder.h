// SPDX-License-Identifier: Apache-2.0
// One H.264 file being written. Private to render/.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/atomic_file.h"
#include "render/video_av.h"
#include "render/video_io.h"
#include "render/video_pixels.h"
#include "render/video_sound.h"

namespace lorgnette {

// What the output takes over from its source.
struct VideoSource {
  std::string path;           // for the sound; empty: none
  int width = 0, height = 0;  // as stored
  AVRational time_base{1, 25}, frame_rate{25, 1}, aspect{0, 1};
  AVPixelFormat format = AV_PIX_FMT_RGB24;
  AVColorRange range = AVCOL_RANGE_UNSPECIFIED;
  AVColorSpace matrix = AVCOL_SPC_UNSPECIFIED;
  AVColorPrimaries primaries = AVCOL_PRI_UNSPECIFIED;
  AVColorTransferCharacteristic transfer = AVCOL_TRC_UNSPECIFIED;
  AVChromaLocation chroma_location = AVCHROMA_LOC_UNSPECIFIED;
  Orientation orientation;
  const AVStream* stream = nullptr;            // for display matrix and metadata
  const AVFormatContext* container = nullptr;  // for metadata
};

class VideoEncoder {
 public:
  static Result<std::unique_ptr<VideoEncoder>> Create(const std::string& path,
                                                      const VideoSource& source,
                                                      const VideoWriterOptions& options);
  ~VideoEncoder();
  Status Write(const VideoFrame& frame);
  Status Finish();

 private:
  VideoEncoder(const std::string& path, const VideoSource& source,
               const VideoWriterOptions& options);
  Status OpenCodec();
  Status OpenFile();
  Status Drain(const AVFrame* frame);  // sends a frame (or the end), writes what comes back
  Status WriteError(int error) const;
  void Close();

  AtomicFile file_;
  VideoSource source_;
  VideoWriterOptions options_;
  AVFormatContext* output_ = nullptr;
  AVStream* stream_ = nullptr;
  av::Codec codec_;
  std::optional<PlanesFromRgb> from_rgb_;
  av::Packet packet_;
  std::unique_ptr<SoundCopier> sound_;
  bool started_ = false;
  long long first_pts_ = 0, last_pts_ = 0;    // of the frames given, time base of the source
  std::map<long long, long long> durations_;  // by output pts, until the packet is written
  long long last_duration_ = 0;
};

}  // namespace lorgnette
