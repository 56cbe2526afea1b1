// SPDX-License-Identifier: Apache-2.0
#include "render/video_av.h"

extern "C" {
#include <libavutil/display.h>
#include <libavutil/log.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

#include <cmath>
#include <cstring>
#include <filesystem>

namespace lorgnette {
namespace av {

std::string Reason(int error) {
  if (error == AVERROR_INVALIDDATA) return "broken data, or no video";
  if (error == AVERROR_EOF) return "it ends too early";
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(error, text, sizeof text);
  return text;
}

void SilenceLog() { av_log_set_level(AV_LOG_QUIET); }

Result<Input> OpenInput(const std::string& path) {
  SilenceLog();
  std::error_code ec;
  if (std::filesystem::is_directory(path, ec)) return Failure(path + ": is a folder, want a file");
  AVFormatContext* raw = nullptr;
  // "file:" keeps a colon in a name from being read as a protocol.
  if (const int error = avformat_open_input(&raw, ("file:" + path).c_str(), nullptr, nullptr);
      error < 0) {
    return Failure(path + ": cannot be read: " + Reason(error));
  }
  Input input(raw);
  if (const int error = avformat_find_stream_info(raw, nullptr); error < 0) {
    return Failure(path + ": cannot be read: " + Reason(error));
  }
  return input;
}

Result<Frame> NewFrame(int width, int height, AVPixelFormat format) {
  Frame frame(av_frame_alloc());
  frame->width = width;
  frame->height = height;
  frame->format = format;
  if (av_frame_get_buffer(frame.get(), 0) < 0) return Failure("no memory for a frame");
  return frame;
}

Result<Codec> OpenDecoder(const AVStream& stream, const std::string& path) {
  const AVCodec* decoder = avcodec_find_decoder(stream.codecpar->codec_id);
  if (decoder == nullptr) {
    return Failure(path + ": no decoder for its format (" +
                   avcodec_get_name(stream.codecpar->codec_id) + ")");
  }
  Codec codec(avcodec_alloc_context3(decoder));
  codec->thread_count = 0;
  codec->pkt_timebase = stream.time_base;
  int error = avcodec_parameters_to_context(codec.get(), stream.codecpar);
  if (error >= 0) error = avcodec_open2(codec.get(), decoder, nullptr);
  if (error < 0) return Failure(path + ": cannot be decoded: " + Reason(error));
  return codec;
}

AVPixelFormat PlainFormat(int format, bool* full_range) {
  switch (format) {
    case AV_PIX_FMT_YUVJ420P:
      *full_range = true;
      return AV_PIX_FMT_YUV420P;
    case AV_PIX_FMT_YUVJ422P:
      *full_range = true;
      return AV_PIX_FMT_YUV422P;
    case AV_PIX_FMT_YUVJ444P:
      *full_range = true;
      return AV_PIX_FMT_YUV444P;
    case AV_PIX_FMT_YUVJ440P:
      *full_range = true;
      return AV_PIX_FMT_YUV440P;
    default:
      return static_cast<AVPixelFormat>(format);
  }
}

int MatrixOf(AVColorSpace space, int width, int height) {
  switch (space) {
    case AVCOL_SPC_BT709:
      return SWS_CS_ITU709;
    case AVCOL_SPC_FCC:
      return SWS_CS_FCC;
    case AVCOL_SPC_SMPTE240M:
      return SWS_CS_SMPTE240M;
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE170M:
      return SWS_CS_ITU601;
    case AVCOL_SPC_BT2020_NCL:
    case AVCOL_SPC_BT2020_CL:
      return SWS_CS_BT2020;
    default:
      return width > 1024 || height > 576 ? SWS_CS_ITU709 : SWS_CS_ITU601;
  }
}

ColourReading ReadingOf(const AVFrame& frame) {
  ColourReading reading;
  reading.matrix = MatrixOf(frame.colorspace, frame.width, frame.height);
  reading.full_range = frame.color_range == AVCOL_RANGE_JPEG;
  PlainFormat(frame.format, &reading.full_range);
  reading.left_sited = frame.chroma_location != AVCHROMA_LOC_CENTER;
  return reading;
}

namespace {

constexpr int kExact =
    SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP | SWS_BITEXACT;

Result<Scaler> MakeScaler(int width, int height, AVPixelFormat from, bool from_full,
                          AVPixelFormat to, bool to_full, const ColourReading& c, bool to_rgb,
                          int flags = kExact) {
  Scaler scaler(sws_alloc_context());
  SwsContext* s = scaler.get();
  av_opt_set_int(s, "srcw", width, 0);
  av_opt_set_int(s, "srch", height, 0);
  av_opt_set_int(s, "dstw", width, 0);
  av_opt_set_int(s, "dsth", height, 0);
  av_opt_set_int(s, "src_format", from, 0);
  av_opt_set_int(s, "dst_format", to, 0);
  av_opt_set_int(s, "src_range", from_full, 0);
  av_opt_set_int(s, "dst_range", to_full, 0);
  av_opt_set_int(s, "sws_flags", flags, 0);
  const AVPixFmtDescriptor* yuv = av_pix_fmt_desc_get(to_rgb ? from : to);
  if (yuv != nullptr && yuv->log2_chroma_w > 0) {
    const char* side = to_rgb ? "src_h_chr_pos" : "dst_h_chr_pos";
    av_opt_set_int(s, side, c.left_sited ? 0 : 128, 0);
  }
  if (yuv != nullptr && yuv->log2_chroma_h > 0) {
    av_opt_set_int(s, to_rgb ? "src_v_chr_pos" : "dst_v_chr_pos", 128, 0);
  }
  const int* table = sws_getCoefficients(c.matrix);
  constexpr int kOne = 1 << 16;  // contrast and saturation unchanged
  sws_setColorspaceDetails(s, table, from_full, table, to_full, 0, kOne, kOne);
  if (sws_init_context(s, nullptr, nullptr) < 0) {
    return Failure(std::string("no conversion from ") + av_get_pix_fmt_name(from) + " to " +
                   av_get_pix_fmt_name(to));
  }
  // Again: the initialisation resets the coefficients of some conversions.
  sws_setColorspaceDetails(s, table, from_full, table, to_full, 0, kOne, kOne);
  return scaler;
}

}  // namespace

Result<Scaler> ScalerToPlanes(int width, int height, AVPixelFormat format, const ColourReading& c) {
  return MakeScaler(width, height, format, c.full_range, AV_PIX_FMT_GBRP, true, c, true);
}

Result<Scaler> ScalerToRgb(int width, int height, AVPixelFormat format, const ColourReading& c) {
  return MakeScaler(width, height, format, c.full_range, AV_PIX_FMT_RGB24, true, c, true);
}

Result<Scaler> ScalerToQuickRgb(int width, int height, AVPixelFormat format,
                                const ColourReading& c) {
  return MakeScaler(width, height, format, c.full_range, AV_PIX_FMT_RGB24, true, c, true,
                    SWS_POINT);
}

bool HasQuickRgb(AVPixelFormat format, int width, int height) {
  // Of another width, libswscale's vector code leaves the last columns out or writes past the end.
  constexpr int kColumns = 16;
  return width % kColumns == 0 && (format == AV_PIX_FMT_YUV420P || format == AV_PIX_FMT_YUV422P) &&
         height % 2 == 0;
}

Result<Scaler> ScalerFromRgb(int width, int height, AVPixelFormat format, const ColourReading& c) {
  return MakeScaler(width, height, AV_PIX_FMT_RGB24, true, format, c.full_range, c, false);
}

}  // namespace av

namespace {

Orientation OrientationOfMatrix(const std::uint8_t* data) {
  std::int32_t m[9];
  std::memcpy(m, data, sizeof m);
  const auto unit = [&](int i) { return static_cast<int>(std::lround(m[i] / 65536.0)); };
  // libav: x' = m0 x + m3 y, y' = m1 x + m4 y.
  const Orientation o{unit(0), unit(3), unit(1), unit(4)};
  const bool quarter = std::abs(o.xx) + std::abs(o.xy) == 1 &&
                       std::abs(o.yx) + std::abs(o.yy) == 1 && std::abs(o.xx) == std::abs(o.yy);
  return quarter ? o : Orientation{};
}

}  // namespace

Orientation OrientationOf(const AVStream& stream) {
  const std::uint8_t* data = av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr);
  return data == nullptr ? Orientation{} : OrientationOfMatrix(data);
}

Orientation OrientationOf(const AVFrame& frame) {
  const AVFrameSideData* data = av_frame_get_side_data(&frame, AV_FRAME_DATA_DISPLAYMATRIX);
  if (data == nullptr || data->size < 9 * sizeof(std::int32_t)) return {};
  return OrientationOfMatrix(data->data);
}

ImageRgb8 Oriented(ImageRgb8 image, const Orientation& o) {
  if (o.is_upright()) return image;
  const int width = o.swaps_sides() ? image.height : image.width;
  const int height = o.swaps_sides() ? image.width : image.height;
  ImageRgb8 result(width, height);
  // A negative step starts at the far side.
  const int x0 = o.xx + o.xy < 0 ? width - 1 : 0;
  const int y0 = o.yx + o.yy < 0 ? height - 1 : 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      std::memcpy(result.at(x0 + o.xx * x + o.xy * y, y0 + o.yx * x + o.yy * y), image.at(x, y), 3);
    }
  }
  return result;
}

}  // namespace lorgnette
