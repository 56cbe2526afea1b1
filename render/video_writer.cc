// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "base/atomic_file.h"
#include "render/image_io.h"
#include "render/video_encoder.h"
#include "render/video_io.h"
#include "render/video_names.h"
#include "render/video_state.h"

namespace lorgnette {

struct VideoWriter::State {
  std::string path;
  std::unique_ptr<VideoEncoder> encoder;  // absent: image files
  int next_number = 1;
  bool single = false;
  // A sequence appears as a whole: files wait under temporary names.
  std::vector<std::unique_ptr<AtomicFile>> images;
};

VideoWriter::VideoWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;
VideoWriter::~VideoWriter() = default;

Result<VideoWriter> VideoWriter::Create(const std::string& path, const VideoReader& reader,
                                        const VideoWriterOptions& options) {
  const VideoReader::State& source = *reader.state_;
  auto state = std::make_unique<State>();
  state->path = path;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code ec;
  if (!folder.empty() && !std::filesystem::is_directory(folder, ec)) {
    return Failure(path + ": cannot be written: no folder " + folder.string());
  }

  if (HasExtension(path, {".png", ".jpg", ".jpeg"})) {
    state->single = !IsSequencePattern(path);
    state->next_number = source.first_number;
    if (state->single && !source.info.is_still) {
      return UsageError(path + ": one image cannot hold the video " + source.path +
                        ", want a video (.mp4) or a sequence (name_%04d.png)");
    }
    return VideoWriter(std::move(state));
  }
  if (!HasExtension(path, {".mp4", ".mov", ".m4v", ".mkv"})) {
    return UsageError(path + ": unknown output format, want .mp4, .mov, .m4v, .mkv, .png or .jpg");
  }

  VideoSource video;
  video.width = source.info.width;
  video.height = source.info.height;
  video.time_base = source.time_base;
  video.frame_rate = source.frame_rate;
  if (source.images.empty()) {
    const AVCodecParameters& parameters = *source.stream()->codecpar;
    if (source.info.has_audio) video.path = source.path;
    video.width = parameters.width;
    video.height = parameters.height;
    video.aspect = av_guess_sample_aspect_ratio(source.input.get(), source.stream(), nullptr);
    video.format = static_cast<AVPixelFormat>(parameters.format);
    video.range = parameters.color_range;
    video.matrix = parameters.color_space;
    video.primaries = parameters.color_primaries;
    video.transfer = parameters.color_trc;
    video.chroma_location = parameters.chroma_location;
    video.orientation = source.orientation;
    video.stream = source.stream();
    video.container = source.input.get();
  }
  LG_ASSIGN(state->encoder, VideoEncoder::Create(path, video, options));
  return VideoWriter(std::move(state));
}

Status VideoWriter::Write(const VideoFrame& frame) {
  State& state = *state_;
  if (state.encoder != nullptr) return state.encoder->Write(frame);
  if (state.single && !state.images.empty()) {
    return Failure(state.path + ": got a second frame, want one image");
  }
  const std::string name =
      state.single ? state.path : SequenceFile(state.path, state.next_number++);
  state.images.push_back(std::make_unique<AtomicFile>(name));
  const Status written = WritePicture(frame.rgb, state.images.back()->temporary_path());
  if (!written) {
    // Says the name that the user knows.
    const std::string reason = written.error().message;
    const std::size_t colon = reason.find(": ");
    return Failure(name + reason.substr(colon == std::string::npos ? 0 : colon));
  }
  return {};
}

Status VideoWriter::Finish() {
  if (state_->encoder != nullptr) return state_->encoder->Finish();
  if (state_->images.empty()) return Failure(state_->path + ": no frame was written");
  for (const auto& image : state_->images) LG_RETURN_IF_ERROR(image->Commit());
  return {};
}

}  // namespace lorgnette
