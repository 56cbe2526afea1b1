// SPDX-License-Identifier: Apache-2.0
extern "C" {
#include <libavutil/display.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "base/atomic_file.h"
#include "render/image_io.h"
#include "render/video_av.h"
#include "render/video_pixels.h"

namespace lorgnette {
namespace {

constexpr std::int64_t kMaxPixels = 1 << 28;

AVCodecID FormatOf(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv)) return AV_CODEC_ID_PNG;
  if (bytes.starts_with("\xff\xd8\xff"sv)) return AV_CODEC_ID_MJPEG;
  if (bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv)) return AV_CODEC_ID_TIFF;
  if (bytes.starts_with("RIFF"sv) && bytes.substr(0, 12).ends_with("WEBP"sv)) {
    return AV_CODEC_ID_WEBP;
  }
  if (bytes.starts_with("BM"sv)) return AV_CODEC_ID_BMP;
  return AV_CODEC_ID_NONE;
}

Result<av::Frame> Decode(const std::string& bytes, AVCodecID format) {
  const AVCodec* decoder = avcodec_find_decoder(format);
  if (decoder == nullptr) return Failure("libavcodec lacks its format");
  av::SilenceLog();
  const av::Codec codec(avcodec_alloc_context3(decoder));
  codec->thread_count = 1;
  codec->max_pixels = kMaxPixels;
  // Of a TIFF, tags that the decoder does not know would count as errors too. One that is cut short
  // is an error all the same.
  if (format != AV_CODEC_ID_TIFF) codec->err_recognition |= AV_EF_EXPLODE;
  int error = avcodec_open2(codec.get(), decoder, nullptr);
  const av::Packet packet(av_packet_alloc());
  if (error >= 0) error = av_new_packet(packet.get(), int(bytes.size()));
  av::Frame frame(av_frame_alloc());
  if (error >= 0) {
    std::copy(bytes.begin(), bytes.end(), packet->data);
    error = avcodec_send_packet(codec.get(), packet.get());
  }
  if (error >= 0) error = avcodec_send_packet(codec.get(), nullptr);
  if (error >= 0) error = avcodec_receive_frame(codec.get(), frame.get());
  if (error >= 0 && frame->decode_error_flags != 0) error = AVERROR_INVALIDDATA;
  if (error < 0) return Failure(av::Reason(error));
  return frame;
}

Result<ImageRgb8> ToRgb(const AVFrame& frame) {
  const AVPixFmtDescriptor* description = av_pix_fmt_desc_get(AVPixelFormat(frame.format));
  if (description == nullptr) return Failure("its pixels have no format");
  av::ColourReading reading = av::ReadingOf(frame);
  const AVPixelFormat format = av::PlainFormat(frame.format, &reading.full_range);
  // Colours and greys as they are; only luma and chroma need arithmetic.
  const bool is_yuv = (description->flags & AV_PIX_FMT_FLAG_RGB) == 0 &&
                      (description->flags & AV_PIX_FMT_FLAG_PAL) == 0 &&
                      description->nb_components >= 3;
  if (!is_yuv) {
    reading.full_range = true;
    LG_ASSIGN(const av::Scaler scaler, av::ScalerToRgb(frame.width, frame.height, format, reading));
    ImageRgb8 rgb(frame.width, frame.height);
    std::uint8_t* pixels = rgb.data.data();
    const int stride = 3 * rgb.width;
    sws_scale(scaler.get(), frame.data, frame.linesize, 0, frame.height, &pixels, &stride);
    return rgb;
  }
  LG_ASSIGN(const av::Scaler scaler,
            av::ScalerToPlanes(frame.width, frame.height, format, reading));
  LG_ASSIGN(const av::Frame planes, av::NewFrame(frame.width, frame.height, AV_PIX_FMT_GBRP));
  sws_scale(scaler.get(), frame.data, frame.linesize, 0, frame.height, planes->data,
            planes->linesize);
  return RgbOfPlanes(*planes);
}

// PNG without loss; JPEG with full chroma at the encoder's best but one quality.
Result<std::string> Encode(const ImageRgb8& image, bool png) {
  const AVCodec* encoder = avcodec_find_encoder(png ? AV_CODEC_ID_PNG : AV_CODEC_ID_MJPEG);
  if (encoder == nullptr) return Failure("libavcodec lacks its format");
  av::SilenceLog();
  const AVPixelFormat format = png ? AV_PIX_FMT_RGB24 : AV_PIX_FMT_YUVJ444P;
  const av::Codec codec(avcodec_alloc_context3(encoder));
  codec->width = image.width;
  codec->height = image.height;
  codec->pix_fmt = format;
  codec->time_base = {1, 25};
  codec->thread_count = 1;
  if (png) {
    codec->compression_level = 3;
    av_opt_set(codec->priv_data, "pred", "up", 0);
  } else {
    codec->color_range = AVCOL_RANGE_JPEG;
    codec->flags |= AV_CODEC_FLAG_QSCALE;
    codec->global_quality = 2 * FF_QP2LAMBDA;
  }
  int error = avcodec_open2(codec.get(), encoder, nullptr);
  if (error < 0) return Failure(av::Reason(error));
  LG_ASSIGN(const av::Frame frame, av::NewFrame(image.width, image.height, format));
  if (png) {
    for (int y = 0; y < image.height; ++y) {
      std::copy_n(image.at(0, y), 3 * image.width, frame->data[0] + y * frame->linesize[0]);
    }
  } else {
    const av::ColourReading reading{SWS_CS_ITU601, true, false};
    LG_ASSIGN(PlanesFromRgb planes,
              PlanesFromRgb::Create(image.width, image.height, AV_PIX_FMT_YUV444P, reading));
    planes.Fill(image, *frame);
    frame->quality = codec->global_quality;
  }
  const av::Packet packet(av_packet_alloc());
  error = avcodec_send_frame(codec.get(), frame.get());
  if (error >= 0) error = avcodec_send_frame(codec.get(), nullptr);
  if (error >= 0) error = avcodec_receive_packet(codec.get(), packet.get());
  if (error < 0) return Failure(av::Reason(error));
  return std::string(reinterpret_cast<const char*>(packet->data), std::size_t(packet->size));
}

}  // namespace

Result<ImageRgb8> ReadPicture(const std::string& path) {
  LG_ASSIGN(const std::string content, ReadFile(path));
  const AVCodecID format = FormatOf(content);
  if (format == AV_CODEC_ID_NONE) {
    return Failure(path + ": not a picture, want PNG, JPEG, BMP, TIFF or WebP");
  }
  const auto why = [&](const Error& error) {
    return Failure(fmt::format("{}: not a picture that can be decoded ({})", path, error.message));
  };
  const auto frame = Decode(content, format);
  if (!frame) return why(frame.error());
  auto rgb = ToRgb(**frame);
  if (!rgb) return why(rgb.error());
  return Oriented(*std::move(rgb), OrientationOf(**frame));
}

Status WritePicture(const ImageRgb8& image, const std::string& path) {
  if (image.empty()) return Failure(fmt::format("{}: the picture has no pixels", path));
  const std::size_t dot = path.find_last_of('.');
  const std::string extension = dot == std::string::npos ? "" : path.substr(dot);
  if (extension != ".png" && extension != ".jpg" && extension != ".jpeg") {
    return UsageError(
        fmt::format("{}: got the extension `{}`, want .png, .jpg or .jpeg", path, extension));
  }
  const auto encoded = Encode(image, extension == ".png");
  if (!encoded) {
    return Failure(
        fmt::format("{}: the picture cannot be encoded ({})", path, encoded.error().message));
  }
  return WriteFileAtomically(path, *encoded);
}

}  // namespace lorgnette
