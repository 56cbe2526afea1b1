// SPDX-License-Identifier: Apache-2.0
#include "render/video_sound.h"

#include <fmt/format.h>

#include <cmath>

namespace lorgnette {

SoundCopier::SoundCopier(av::Input input, AVFormatContext* output)
    : input_(std::move(input)), output_(output), packet_(av_packet_alloc()) {}

Result<std::unique_ptr<SoundCopier>> SoundCopier::Open(const std::string& source,
                                                       AVFormatContext* output,
                                                       const std::string& output_name) {
  LG_ASSIGN(av::Input input, av::OpenInput(source));
  std::vector<int> map(input->nb_streams, -1);
  bool any = false;
  for (unsigned i = 0; i < input->nb_streams; ++i) {
    AVStream* from = input->streams[i];
    if (from->codecpar->codec_type != AVMEDIA_TYPE_AUDIO) {
      from->discard = AVDISCARD_ALL;
      continue;
    }
    const AVCodecID id = from->codecpar->codec_id;
    if (avformat_query_codec(output->oformat, id, FF_COMPLIANCE_NORMAL) == 0) {
      return UsageError(
          fmt::format("{}: this container cannot hold the sound ({}) of {}, want .mkv or .mov",
                      output_name, avcodec_get_name(id), source));
    }
    AVStream* to = avformat_new_stream(output, nullptr);
    if (to == nullptr || avcodec_parameters_copy(to->codecpar, from->codecpar) < 0) {
      return Failure(fmt::format("{}: the sound of {} cannot be copied", output_name, source));
    }
    to->codecpar->codec_tag = 0;
    to->time_base = from->time_base;
    to->disposition = from->disposition;
    av_dict_copy(&to->metadata, from->metadata, 0);
    map[i] = to->index;
    any = true;
  }
  if (!any) return nullptr;
  std::unique_ptr<SoundCopier> copier(new SoundCopier(std::move(input), output));
  copier->stream_map_ = std::move(map);
  return copier;
}

int SoundCopier::ReadNext() {
  while (!pending_ && !ended_) {
    const int error = av_read_frame(input_.get(), packet_.get());
    if (error == AVERROR_EOF) {
      ended_ = true;
      return 0;
    }
    if (error < 0) return error;
    const AVStream* stream = input_->streams[packet_->stream_index];
    const double time = static_cast<double>(packet_->pts) * av_q2d(stream->time_base);
    const bool wanted =
        stream_map_[packet_->stream_index] >= 0 && (begin_s_ == 0 || time >= begin_s_);
    if (wanted) {
      pending_ = true;
    } else {
      av_packet_unref(packet_.get());
    }
  }
  return 0;
}

int SoundCopier::CopyUntil(double end_s) {
  while (true) {
    if (const int error = ReadNext(); error < 0) return error;
    if (!pending_) return 0;
    const AVRational from = input_->streams[packet_->stream_index]->time_base;
    if (static_cast<double>(packet_->pts) * av_q2d(from) >= end_s) return 0;
    pending_ = false;
    const long long shift = std::llround(begin_s_ / av_q2d(from));
    if (packet_->pts != AV_NOPTS_VALUE) packet_->pts -= shift;
    if (packet_->dts != AV_NOPTS_VALUE) packet_->dts -= shift;
    AVStream* to = output_->streams[stream_map_[packet_->stream_index]];
    packet_->stream_index = to->index;
    packet_->pos = -1;
    av_packet_rescale_ts(packet_.get(), from, to->time_base);
    if (const int error = av_interleaved_write_frame(output_, packet_.get()); error < 0) {
      return error;
    }
  }
}

}  // namespace lorgnette
