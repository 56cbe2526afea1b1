// SPDX-License-Identifier: Apache-2.0
#include "apps/frame_assembly.h"

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <filesystem>

#include "apps/stage_timer.h"
#include "apps/still_choice.h"
#include "render/color.h"

namespace lorgnette {
namespace {

constexpr std::size_t kFramesInFlight = 4;

ImageRgb8 Beside(const ImageRgb8& left, const ImageRgb8& right) {
  ImageRgb8 both(left.width + right.width, left.height);
  for (int y = 0; y < left.height; ++y) {
    std::copy_n(left.at(0, y), 3 * left.width, both.at(0, y));
    std::copy_n(right.at(0, y), 3 * right.width, both.at(left.width, y));
  }
  return both;
}

}  // namespace

FrameAssembly::FrameAssembly(const TryonRequest& request, VideoReader& reader, VideoWriter& writer,
                             Compositor& compositor, const HeadTrack& track, TryonResult& result,
                             RenderJournal* journal)
    : request_(request),
      reader_(reader),
      writer_(writer),
      compositor_(compositor),
      track_(track),
      motion_(track.face, result.eyewear->frame, result.eyewear->head_from_frame),
      lookup_(track, reader.info().frame_rate),
      chosen_(ChooseStills(track, request.stills)),
      result_(result),
      journal_(journal),
      rectifier_(RectifierFor(track.camera, track.distortion)),
      progress_("rendering", "frames", static_cast<long>(track.frames.size())) {}

Status FrameAssembly::Run() {
  // Nested parallelism of the compositor may not steal another stage into this stage's time.
  const auto isolated = [](auto&& work) { return tbb::this_task_arena::isolate(work); };
  tbb::parallel_pipeline(
      kFramesInFlight,
      tbb::make_filter<void, std::shared_ptr<Job>>(tbb::filter_mode::serial_in_order,
                                                   [&](tbb::flow_control& control) {
                                                     auto job = isolated([&] { return Read(); });
                                                     if (job == nullptr) control.stop();
                                                     return job;
                                                   }) &
          tbb::make_filter<std::shared_ptr<Job>, std::shared_ptr<Job>>(
              tbb::filter_mode::serial_in_order,
              [&](std::shared_ptr<Job> job) {
                isolated([&] { Render(*job); });
                return job;
              }) &
          tbb::make_filter<std::shared_ptr<Job>, void>(
              tbb::filter_mode::serial_in_order,
              [&](const std::shared_ptr<Job>& job) { isolated([&] { Write(*job); }); }));
  if (!status_) return status_;
  if (result_.frames == 0) {
    return UsageError(fmt::format("--frames: {} has only {} frames", request_.video, number_));
  }
  return {};
}

std::shared_ptr<FrameAssembly::Job> FrameAssembly::Read() {
  const StageTimer timer(result_.seconds.read);
  while (!failed_ && number_ <= request_.frames.last) {
    auto frame = reader_.Next();
    if (!frame) return Fail(frame.error());
    if (!*frame) return nullptr;
    if (!request_.frames.Contains(number_++)) continue;
    auto job = std::make_shared<Job>();
    job->frame = **std::move(frame);
    job->tracked = lookup_.At(job->frame.time_s);
    if (job->tracked == nullptr) {
      return Fail(Error{fmt::format("{}: has no frame at {:.3f} s of {}", request_.track,
                                    job->frame.time_s, request_.video),
                        ErrorKind::kFailure});
    }
    return job;
  }
  return nullptr;
}

void FrameAssembly::Render(Job& job) {
  if (!job.tracked->found || failed_) return;
  const StageTimer timer(result_.seconds.render);
  if (!job.tracked->vertices.empty()) {
    compositor_.UpdateFace(motion_.Held(job.tracked->vertices));
  }
  if (request_.stills_beside_input && IsStill(job)) job.input = job.frame.rgb;
  // Glasses are drawn into the pinhole's picture and brought back into the lens's.
  ImageRgb8 rectified;
  if (rectifier_) rectified = rectifier_->Rectified(job.frame.rgb);
  const ImageRgb8& seen = rectifier_ ? rectified : job.frame.rgb;
  if (!exposed_) {
    result_.environment_scale =
        compositor_.MatchExposure(seen, track_.camera, job.tracked->camera_from_head);
    compositor_.SetEnvironmentScale(result_.environment_scale);
    compositor_.SetCameraLook(MeasureCameraLook(LinearFromDisplay(seen)));
    exposed_ = true;
  }
  const long number = job.tracked - track_.frames.data();
  // The first plan is reported: that frame is always drawn.
  if (journal_ != nullptr && !result_.first_plan.decisions.empty()) {
    if (const auto tally = journal_->Restore(number, job.frame.rgb)) {
      Count(*tally);
      return;
    }
  }
  EffectPlan plan;
  FrameTally tally;
  ImageRgb8 drawn = compositor_.Render(seen, track_.camera, job.tracked->camera_from_head,
                                       request_.effects, plan, &tally.counts);
  if (result_.first_plan.decisions.empty()) result_.first_plan = plan;
  for (const EffectDecision& d : plan.decisions) {
    tally.effects[std::size_t(d.region)] |= std::uint32_t(d.on) << unsigned(d.effect);
  }
  Count(tally);
  if (rectifier_) drawn = rectifier_->WithChanges(job.frame.rgb, rectified, drawn);
  if (journal_ != nullptr) {
    if (const Status kept = journal_->Keep(number, job.frame.rgb, drawn, tally); !kept) {
      Fail(kept.error());
    }
  }
  job.frame.rgb = std::move(drawn);
}

void FrameAssembly::Count(const FrameTally& tally) {
  result_.counts.lens_pixels += tally.counts.lens_pixels;
  result_.counts.frame_pixels += tally.counts.frame_pixels;
  result_.counts.shadowed_pixels += tally.counts.shadowed_pixels;
  result_.counts.filled_samples += tally.counts.filled_samples;
  for (std::size_t region = 0; region < tally.effects.size(); ++region) {
    for (std::size_t effect = 0; effect < kEffectCount; ++effect) {
      result_.effect_frames[region][effect] += (tally.effects[region] >> effect) & 1u;
    }
  }
}

void FrameAssembly::Write(Job& job) {
  if (failed_) return;
  const StageTimer timer(result_.seconds.write);
  if (const Status written = writer_.Write(job.frame); !written) {
    Fail(written.error());
    return;
  }
  ++result_.frames;
  if (!job.tracked->found) ++result_.frames_without_face;
  if (IsStill(job)) KeepStill(job);
  progress_.Update(result_.frames);
}

bool FrameAssembly::IsStill(const Job& job) const {
  const long index = job.tracked - track_.frames.data();
  return std::find(chosen_.begin(), chosen_.end(), index) != chosen_.end();
}

void FrameAssembly::KeepStill(const Job& job) {
  const std::filesystem::path output(request_.output);
  const std::string name = fmt::format("{}_still_{:04d}.png", output.stem().string(),
                                       static_cast<int>(stills_.size()) + 1);
  stills_.emplace_back(
      (output.parent_path() / name).string(),
      request_.stills_beside_input ? Beside(job.input, job.frame.rgb) : job.frame.rgb);
}

std::nullptr_t FrameAssembly::Fail(const Error& error) {
  if (!failed_.exchange(true)) status_ = tl::unexpected(error);
  return nullptr;
}

}  // namespace lorgnette
