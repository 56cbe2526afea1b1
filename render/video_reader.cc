// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "render/image_io.h"
#include "render/video_io.h"
#include "render/video_names.h"
#include "render/video_pixels.h"
#include "render/video_state.h"

namespace lorgnette {
namespace {

const std::vector<std::string>& StillExtensions() {
  static const std::vector<std::string> extensions = {".png", ".jpg",  ".jpeg", ".bmp",
                                                      ".tif", ".tiff", ".webp"};
  return extensions;
}

}  // namespace

VideoReader::VideoReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
VideoReader::VideoReader(VideoReader&&) noexcept = default;
VideoReader& VideoReader::operator=(VideoReader&&) noexcept = default;
VideoReader::~VideoReader() = default;
const VideoInfo& VideoReader::info() const { return state_->info; }
const std::string& VideoReader::path() const { return state_->path; }

Result<VideoReader> VideoReader::Open(const std::string& path, const VideoReaderOptions& options) {
  auto state = std::make_unique<State>();
  state->options = options;
  state->path = path;
  VideoInfo& info = state->info;

  if (IsSequencePattern(path)) {
    LG_ASSIGN(Sequence sequence, ListSequence(path));
    state->images = std::move(sequence.files);
    state->first_number = sequence.first_number;
  } else if (HasExtension(path, StillExtensions())) {
    state->images = {path};
    info.is_still = true;
  }
  if (!state->images.empty()) {
    LG_ASSIGN(const ImageRgb8 first, ReadPicture(state->images.front()));
    info.width = first.width;
    info.height = first.height;
    info.frame_count = static_cast<long>(state->images.size());
    return VideoReader(std::move(state));
  }

  LG_ASSIGN(state->input, av::OpenInput(path));
  AVFormatContext* input = state->input.get();
  state->stream_index = av_find_best_stream(input, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (state->stream_index < 0) return Failure(path + ": holds no video");
  AVStream* stream = state->stream();
  LG_ASSIGN(state->decoder, av::OpenDecoder(*stream, path));
  state->packet.reset(av_packet_alloc());
  state->orientation = OrientationOf(*stream);
  state->time_base = stream->time_base;
  const AVRational rate = av_guess_frame_rate(input, stream, nullptr);
  const AVRational average = stream->avg_frame_rate;
  if (average.num > 0 && average.den > 0) {
    state->frame_rate = average;
  } else if (rate.num > 0 && rate.den > 0) {
    state->frame_rate = rate;
  }
  info.frame_rate = av_q2d(state->frame_rate);

  const AVCodecParameters& parameters = *stream->codecpar;
  if (parameters.width <= 0 || parameters.height <= 0) {
    return Failure(path + ": its video has no size");
  }
  info.width = state->orientation.swaps_sides() ? parameters.height : parameters.width;
  info.height = state->orientation.swaps_sides() ? parameters.width : parameters.height;
  info.frame_count = stream->nb_frames;
  if (info.frame_count <= 0 && input->duration > 0) {
    const double seconds = static_cast<double>(input->duration) / AV_TIME_BASE;
    info.frame_count = std::lround(seconds * info.frame_rate);
  }
  for (unsigned i = 0; i < input->nb_streams; ++i) {
    const bool audio = input->streams[i]->codecpar->codec_type == AVMEDIA_TYPE_AUDIO;
    info.has_audio = info.has_audio || audio;
    // The writer reads the sound by itself.
    if (static_cast<int>(i) != state->stream_index) input->streams[i]->discard = AVDISCARD_ALL;
  }
  return VideoReader(std::move(state));
}

Result<std::optional<VideoFrame>> VideoReader::Next() {
  return state_->images.empty() ? state_->NextFrame() : state_->NextImage();
}

std::string VideoReader::State::Where() const {
  return fmt::format("at {:.2f} s (after {} frames)",
                     static_cast<double>(last_pts) * av_q2d(time_base), frames_read);
}

Result<std::optional<VideoFrame>> VideoReader::State::NextImage() {
  if (next_image == images.size()) return std::nullopt;
  const std::string& file = images[next_image];
  VideoFrame frame;
  LG_ASSIGN(frame.rgb, ReadPicture(file));
  if (frame.rgb.width != info.width || frame.rgb.height != info.height) {
    return Failure(fmt::format("{}: got {}x{} pixels, want {}x{} as in {}", file, frame.rgb.width,
                               frame.rgb.height, info.width, info.height, images.front()));
  }
  frame.pts = static_cast<long long>(next_image++);
  frame.time_s = static_cast<double>(frame.pts) * av_q2d(time_base);
  return frame;
}

// Feeds the decoder with the next packet of the video, or with the end.
Status VideoReader::State::ReadPacket() {
  int error = 0;
  do {
    av_packet_unref(packet.get());
    error = av_read_frame(input.get(), packet.get());
  } while (error >= 0 && packet->stream_index != stream_index);
  // A cut file shows as a short packet, a bad offset, or an i/o error; only a clean end is one.
  const bool io_error = input->pb != nullptr && input->pb->error < 0;
  if (error == AVERROR_EOF && !io_error) {
    flushed = true;
    avcodec_send_packet(decoder.get(), nullptr);
    return {};
  }
  if (error < 0 || (packet->flags & AV_PKT_FLAG_CORRUPT) != 0) {
    return Failure(path + ": is cut short or broken " + Where());
  }
  error = avcodec_send_packet(decoder.get(), packet.get());
  const bool starting = frames_read == 0 && error == AVERROR_INVALIDDATA;
  if (error < 0 && !starting) {
    return Failure(path + ": is broken " + Where() + ": " + av::Reason(error));
  }
  return {};
}

Status VideoReader::State::SetScaler(const AVFrame& frame) {
  if (frame.format == scaler_format) return {};
  reading = av::ReadingOf(frame);
  bool full_range = false;
  const AVPixelFormat format = av::PlainFormat(frame.format, &full_range);
  const bool quick = !options.exact_colours && av::HasQuickRgb(format, frame.width, frame.height);
  auto converter = quick ? av::ScalerToQuickRgb(frame.width, frame.height, format, reading)
                         : av::ScalerToPlanes(frame.width, frame.height, format, reading);
  if (!converter) return Failure(path + ": " + converter.error().message);
  scaler = *std::move(converter);
  planes.reset();
  scaler_format = frame.format;
  if (quick) return {};
  auto made = av::NewFrame(frame.width, frame.height, AV_PIX_FMT_GBRP);
  if (!made) return Failure(path + ": " + made.error().message);
  planes = *std::move(made);
  return {};
}

ImageRgb8 VideoReader::State::RgbOf(const AVFrame& frame) const {
  if (planes == nullptr) {
    ImageRgb8 rgb(frame.width, frame.height);
    std::uint8_t* pixels = rgb.data.data();
    const int stride = 3 * rgb.width;
    sws_scale(scaler.get(), frame.data, frame.linesize, 0, frame.height, &pixels, &stride);
    return rgb;
  }
  sws_scale(scaler.get(), frame.data, frame.linesize, 0, frame.height, planes->data,
            planes->linesize);
  return RgbOfPlanes(*planes);
}

Result<std::optional<VideoFrame>> VideoReader::State::NextFrame() {
  auto picture = std::make_shared<DecodedPicture>();
  picture->frame.reset(av_frame_alloc());
  AVFrame& stored = *picture->frame;
  int error = 0;
  while (true) {
    error = avcodec_receive_frame(decoder.get(), &stored);
    // Before the first picture, packets may lack the key frame that they refer to.
    const bool starting = error == AVERROR_INVALIDDATA && frames_read == 0 && !flushed;
    if (error != AVERROR(EAGAIN) && !starting) break;
    LG_RETURN_IF_ERROR(ReadPacket());
  }
  if (error == AVERROR_EOF && frames_read == 0) {
    return Failure(path + ": no picture could be decoded");
  }
  if (error == AVERROR_EOF) return std::nullopt;
  if (error < 0) return Failure(path + ": is broken " + Where() + ": " + av::Reason(error));

  const bool swap = orientation.swaps_sides();
  if (stored.width != (swap ? info.height : info.width) ||
      stored.height != (swap ? info.width : info.height)) {
    return Failure(fmt::format("{}: changes its size to {}x{} {}, want one size", path,
                               stored.width, stored.height, Where()));
  }
  LG_RETURN_IF_ERROR(SetScaler(stored));
  VideoFrame frame;
  frame.rgb = Oriented(RgbOf(stored), orientation);
  frame.pts = stored.best_effort_timestamp;
  if (frame.pts == AV_NOPTS_VALUE) {  // raw streams: by the frame rate
    frame.pts = av_rescale_q(frames_read, av_inv_q(frame_rate), time_base);
  }
  frame.time_s = static_cast<double>(frame.pts) * av_q2d(time_base);
  if (options.keep_originals) {
    picture->rgb = frame.rgb;
    frame.original = std::move(picture);
  }
  last_pts = frame.pts;
  ++frames_read;
  return frame;
}

}  // namespace lorgnette
