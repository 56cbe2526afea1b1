// SPDX-License-Identifier: Apache-2.0
// What reader and writer share of libav: owners, errors, orientation, colour. Private to render/.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include <memory>
#include <string>

#include "base/image.h"
#include "base/result.h"

namespace lorgnette {

namespace av {

struct Deleter {
  void operator()(AVFrame* p) const { av_frame_free(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
  void operator()(SwsContext* p) const { sws_freeContext(p); }
};
struct InputDeleter {
  void operator()(AVFormatContext* p) const { avformat_close_input(&p); }
};
using Frame = std::unique_ptr<AVFrame, Deleter>;
using Packet = std::unique_ptr<AVPacket, Deleter>;
using Codec = std::unique_ptr<AVCodecContext, Deleter>;
using Scaler = std::unique_ptr<SwsContext, Deleter>;
using Input = std::unique_ptr<AVFormatContext, InputDeleter>;

// libav's words for an error code; plain ones for "invalid data" and the like.
std::string Reason(int error);

// Errors reach the user as one sentence of ours, so libav and x264 write nothing themselves.
void SilenceLog();

// With buffers allocated.
Result<Frame> NewFrame(int width, int height, AVPixelFormat format);

// Opens a container and finds its streams; the error names the path.
Result<Input> OpenInput(const std::string& path);
// Decoder for one stream, opened.
Result<Codec> OpenDecoder(const AVStream& stream, const std::string& path);

// Format without the deprecated "J" names; their meaning (full range) goes to *full_range.
AVPixelFormat PlainFormat(int format, bool* full_range);

// How YUV of this picture has to be read: with unspecified tags resolved by size.
struct ColourReading {
  int matrix = SWS_CS_ITU709;  // SWS_CS_*
  bool full_range = false;
  bool left_sited = true;  // chroma samples level with the left luma column (video), or centred
};
ColourReading ReadingOf(const AVFrame& frame);
// SWS_CS_* of a tag; by size when it names none.
int MatrixOf(AVColorSpace space, int width, int height);

// Converters between YUV and RGB of one size, with accurate rounding: from `format` to planes
// (GBRP, for which libswscale has vector code; to packed RGB it takes five times as long), and from
// packed RGB24 to `format`. To packed RGB24, from colours and greys without loss.
Result<Scaler> ScalerToPlanes(int width, int height, AVPixelFormat format, const ColourReading& c);
Result<Scaler> ScalerToRgb(int width, int height, AVPixelFormat format, const ColourReading& c);
// To packed RGB24 by libswscale's shortest way; see HasQuickRgb for what it is there for.
Result<Scaler> ScalerToQuickRgb(int width, int height, AVPixelFormat format,
                                const ColourReading& c);
bool HasQuickRgb(AVPixelFormat format, int width, int height);
Result<Scaler> ScalerFromRgb(int width, int height, AVPixelFormat format, const ColourReading& c);

}  // namespace av

// A picture's turn, by quarters, and mirror: upright = matrix * stored, about the centre; columns
// to the right, rows down.
struct Orientation {
  int xx = 1, xy = 0, yx = 0, yy = 1;
  bool is_upright() const { return xx == 1 && yy == 1; }
  bool swaps_sides() const { return xy != 0; }
  Orientation Inverse() const { return {xx, yx, xy, yy}; }
};
// Of the display matrix of a stream, or of a picture (EXIF); identity when there is none, or when
// it is no quarter turn.
Orientation OrientationOf(const AVStream& stream);
Orientation OrientationOf(const AVFrame& frame);
ImageRgb8 Oriented(ImageRgb8 image, const Orientation& orientation);

struct DecodedPicture {
  av::Frame frame;  // as stored in the file
  ImageRgb8 rgb;    // what the reader made of it, upright
};

}  // namespace lorgnette
