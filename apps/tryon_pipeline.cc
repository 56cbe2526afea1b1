// SPDX-License-Identifier: Apache-2.0
#include "apps/tryon_pipeline.h"

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>

#include "apps/camera_choice.h"
#include "apps/oma_export.h"
#include "apps/program.h"
#include "apps/render_journal.h"
#include "apps/rx_file.h"
#include "apps/still_choice.h"
#include "apps/track_pipeline.h"
#include "apps/tryon_report.h"
#include "base/atomic_file.h"
#include "base/progress.h"
#include "geometry/face_motion.h"
#include "geometry/frame_io.h"
#include "geometry/head_occluder.h"
#include "render/color.h"
#include "render/environment.h"
#include "render/face_light.h"
#include "render/image_io.h"
#include "render/video_io.h"

namespace lorgnette {
namespace {

using Clock = std::chrono::steady_clock;

// Adds the life time of a scope to a number of seconds.
class Timer {
 public:
  explicit Timer(double& seconds) : seconds_(seconds), start_(Clock::now()) {}
  ~Timer() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

 private:
  double& seconds_;
  Clock::time_point start_;
};

constexpr double kPdAgreement_mm = 0.05;
constexpr std::size_t kFramesInFlight = 4;

Result<Environment> ReadEnvironment(const TryonRequest& request, TryonResult& result) {
  const std::string path = request.environment.empty() ? DefaultEnvironment() : request.environment;
  if (path.empty()) {
    result.environment = "even grey";
    result.warnings.emplace_back("no environment: lit by even grey light");
    return Environment::Constant({1, 1, 1});
  }
  result.environment = path;
  std::string warning;
  LG_ASSIGN(Environment environment, Environment::Read(path, &warning));
  if (!warning.empty()) result.warnings.push_back(warning);
  return environment;
}

// The tracked frames of a clip by time, since a track may hold a part of it.
class TrackLookup {
 public:
  TrackLookup(const HeadTrack& track, double frame_rate)
      : track_(track), tolerance_s_(0.25 / frame_rate) {}
  const TrackedFrame* At(double time_s) const {
    const auto& frames = track_.frames;
    const auto after = std::lower_bound(
        frames.begin(), frames.end(), time_s - tolerance_s_,
        [](const TrackedFrame& frame, double time) { return frame.time_s < time; });
    if (after == frames.end() || after->time_s > time_s + tolerance_s_) return nullptr;
    return &*after;
  }

 private:
  const HeadTrack& track_;
  double tolerance_s_;
};

// The environment with the broad light that the first tracked picture shows on the face.
Result<Environment> LitLikeTheFace(const TryonRequest& request, const HeadTrack& track,
                                   TryonResult& result) {
  const std::string path = DefaultEnvironment();
  Environment detail = Environment::Constant({1, 1, 1});
  if (!path.empty()) {
    LG_ASSIGN(detail, Environment::Read(path));
  }
  LG_ASSIGN(VideoReader reader, VideoReader::Open(request.video, {.keep_originals = false}));
  const TrackLookup lookup(track, reader.info().frame_rate);
  while (true) {
    LG_ASSIGN(const std::optional<VideoFrame> frame, reader.Next());
    if (!frame) break;
    const TrackedFrame* tracked = lookup.At(frame->time_s);
    if (tracked == nullptr || !tracked->found) continue;
    TriangleMesh face = track.face;
    ComputeVertexNormals(face);
    const auto light =
        FitFaceLight(LinearFromDisplay(frame->rgb), track.camera, tracked->camera_from_head, face,
                     request.compositor.world_from_camera);
    if (!light) break;
    result.environment =
        fmt::format("the face of the first frame{}{}", path.empty() ? "" : " and ", path);
    return path.empty() ? EnvironmentOf(*light) : Relit(detail, *light);
  }
  result.environment = path.empty() ? "even grey" : path;
  result.warnings.emplace_back("the face does not tell its light: the default environment is used");
  return detail;
}

// Says of which lenses the front is the prescription file's own.
void NoteOrderedFronts(const std::string& rx, const EyewearOptions& options, Eyewear& eyewear) {
  for (std::size_t eye = 0; eye < options.base_curves.size(); ++eye) {
    if (!options.base_curves[eye]) continue;
    eyewear.wearing.notes.push_back(fmt::format("{} lens: front of {:.2f} D, as FRNT of {} says",
                                                eye == 0 ? "right" : "left",
                                                options.base_curves[eye]->value(), rx));
  }
}

// Cuts a track down to the frames of a range of the video, and says when one is missing. What the
// frames' times are, only the video knows.
Status KeepRange(const TryonRequest& request, HeadTrack& track) {
  LG_ASSIGN(VideoReader reader, VideoReader::Open(request.video, {.keep_originals = false}));
  const TrackLookup lookup(track, reader.info().frame_rate);
  std::vector<TrackedFrame> kept;
  long number = 0;
  for (; number <= request.frames.last; ++number) {
    LG_ASSIGN(const std::optional<VideoFrame> frame, reader.Next());
    if (!frame) break;
    if (!request.frames.Contains(number)) continue;
    const TrackedFrame* tracked = lookup.At(frame->time_s);
    if (tracked == nullptr) {
      return Failure(fmt::format("{}: has no frame at {:.3f} s of {}", request.track, frame->time_s,
                                 request.video));
    }
    kept.push_back(*tracked);
  }
  if (kept.empty()) {
    return UsageError(fmt::format("--frames: {} has only {} frames", request.video, number));
  }
  track.frames = std::move(kept);
  return {};
}

Result<HeadTrack> GetTrack(const TryonRequest& request, const VideoInfo& video,
                           const Prescription& rx) {
  if (request.track.empty()) {
    TrackRequest tracking;
    tracking.video = request.video;
    tracking.model_dir = request.model_dir;
    tracking.frames = request.frames;
    tracking.pd_mm = rx.pd_mm();
    tracking.focal_px = request.focal_px;
    tracking.camera = request.camera;
    return TrackVideo(tracking);
  }
  LG_ASSIGN(HeadTrack track, ReadHeadTrack(request.track));
  if (track.camera.width != video.width || track.camera.height != video.height) {
    return Failure(fmt::format("{}: is of a video of {}x{} pixels, and {} has {}x{}", request.track,
                               track.camera.width, track.camera.height, request.video, video.width,
                               video.height));
  }
  if (std::abs(track.pd_mm - rx.pd_mm()) > kPdAgreement_mm) {
    return Failure(fmt::format("{}: was made for a PD of {} mm, and {} says {}; track again",
                               request.track, track.pd_mm, request.rx, rx.pd_mm()));
  }
  if (!request.frames.IsWhole()) LG_RETURN_IF_ERROR(KeepRange(request, track));
  return track;
}

// What a render is of: the command, the program, and all that it reads.
std::uint64_t KeyOf(const TryonRequest& request, const HeadTrack& track) {
  std::uint64_t key = HashOf(std::string(ProgramVersion()) + '\n' + request.command_line);
  for (const std::string& path :
       {request.video, request.rx, request.frame, request.environment, request.camera}) {
    if (!path.empty()) key = HashOfFile(path, key);
  }
  for (const TrackedFrame& frame : track.frames) {
    for (const double v : frame.camera_from_head.matrix().reshaped()) {
      key = HashOf(fmt::format("{:.17g} ", v), key);
    }
  }
  return key;
}

void SummarizePoses(const HeadTrack& track, TryonResult& result) {
  bool any = false;
  double squares = 0;
  long found = 0;
  for (const TrackedFrame& frame : track.frames) {
    if (!frame.found) continue;
    const HeadAngles angles = AnglesOf(frame.camera_from_head);
    if (!any) result.least = result.greatest = angles;
    any = true;
    for (double HeadAngles::*angle : {&HeadAngles::yaw, &HeadAngles::pitch, &HeadAngles::roll}) {
      result.least.*angle = std::min(result.least.*angle, angles.*angle);
      result.greatest.*angle = std::max(result.greatest.*angle, angles.*angle);
    }
    squares += double(frame.residual_px) * double(frame.residual_px);
    ++found;
  }
  result.mean_residual_px = found > 0 ? std::sqrt(squares / double(found)) : 0;
}

ImageRgb8 Beside(const ImageRgb8& left, const ImageRgb8& right) {
  ImageRgb8 both(left.width + right.width, left.height);
  for (int y = 0; y < left.height; ++y) {
    std::copy_n(left.at(0, y), 3 * left.width, both.at(0, y));
    std::copy_n(right.at(0, y), 3 * right.width, both.at(left.width, y));
  }
  return both;
}

// One frame on its way through the pipeline.
struct FrameJob {
  VideoFrame frame;
  const TrackedFrame* tracked = nullptr;
  ImageRgb8 input;  // as read, of stills that show it
};

// The frames of the range, read, composed and written in order, the three overlapping.
class Assembly {
 public:
  Assembly(const TryonRequest& request, VideoReader& reader, VideoWriter& writer,
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

  Status Run() {
    // Nested parallelism of the compositor may not steal another stage into this stage's time.
    const auto isolated = [](auto&& work) { return tbb::this_task_arena::isolate(work); };
    tbb::parallel_pipeline(
        kFramesInFlight,
        tbb::make_filter<void, std::shared_ptr<FrameJob>>(tbb::filter_mode::serial_in_order,
                                                          [&](tbb::flow_control& control) {
                                                            auto job =
                                                                isolated([&] { return Read(); });
                                                            if (job == nullptr) control.stop();
                                                            return job;
                                                          }) &
            tbb::make_filter<std::shared_ptr<FrameJob>, std::shared_ptr<FrameJob>>(
                tbb::filter_mode::serial_in_order,
                [&](std::shared_ptr<FrameJob> job) {
                  isolated([&] { Render(*job); });
                  return job;
                }) &
            tbb::make_filter<std::shared_ptr<FrameJob>, void>(
                tbb::filter_mode::serial_in_order,
                [&](const std::shared_ptr<FrameJob>& job) { isolated([&] { Write(*job); }); }));
    if (!status_) return status_;
    if (result_.frames == 0) {
      return UsageError(fmt::format("--frames: {} has only {} frames", request_.video, number_));
    }
    return {};
  }

  std::vector<std::pair<std::string, ImageRgb8>>& stills() { return stills_; }

 private:
  // The next frame of the range; nullptr at the end, or after an error.
  std::shared_ptr<FrameJob> Read() {
    const Timer timer(result_.seconds.read);
    while (!failed_ && number_ <= request_.frames.last) {
      auto frame = reader_.Next();
      if (!frame) return Fail(frame.error());
      if (!*frame) return nullptr;
      if (!request_.frames.Contains(number_++)) continue;
      auto job = std::make_shared<FrameJob>();
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

  void Render(FrameJob& job) {
    if (!job.tracked->found || failed_) return;
    const Timer timer(result_.seconds.render);
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

  void Count(const FrameTally& tally) {
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

  void Write(FrameJob& job) {
    if (failed_) return;
    const Timer timer(result_.seconds.write);
    if (const Status written = writer_.Write(job.frame); !written) {
      Fail(written.error());
      return;
    }
    ++result_.frames;
    if (!job.tracked->found) ++result_.frames_without_face;
    if (IsStill(job)) KeepStill(job);
    progress_.Update(result_.frames);
  }

  bool IsStill(const FrameJob& job) const {
    const long index = job.tracked - track_.frames.data();
    return std::find(chosen_.begin(), chosen_.end(), index) != chosen_.end();
  }

  void KeepStill(const FrameJob& job) {
    const std::filesystem::path output(request_.output);
    const std::string name = fmt::format("{}_still_{:04d}.png", output.stem().string(),
                                         static_cast<int>(stills_.size()) + 1);
    stills_.emplace_back(
        (output.parent_path() / name).string(),
        request_.stills_beside_input ? Beside(job.input, job.frame.rgb) : job.frame.rgb);
  }

  std::nullptr_t Fail(const Error& error) {
    if (!failed_.exchange(true)) status_ = tl::unexpected(error);
    return nullptr;
  }

  const TryonRequest& request_;
  VideoReader& reader_;
  VideoWriter& writer_;
  Compositor& compositor_;
  const HeadTrack& track_;
  FaceMotion motion_;
  TrackLookup lookup_;
  std::vector<long> chosen_;
  TryonResult& result_;
  RenderJournal* journal_;  // null: none
  std::optional<PictureRectifier> rectifier_;
  Progress progress_;
  long number_ = 0;
  bool exposed_ = false;
  std::atomic<bool> failed_ = false;
  Status status_;
  std::vector<std::pair<std::string, ImageRgb8>> stills_;
};

}  // namespace

std::string DefaultEnvironment() {
  const std::filesystem::path models(DefaultModelDirectory());
  const std::filesystem::path path = models.parent_path() / "inputs" / "environment.exr";
  std::error_code ec;
  return std::filesystem::exists(path, ec) ? path.string() : std::string();
}

HeadAngles AnglesOf(const Eigen::Isometry3d& camera_from_head) {
  // Seen from the camera with y up and z toward it, the head's own axes when it faces the camera.
  const Eigen::Matrix3d r = Eigen::Vector3d(1, -1, -1).asDiagonal() * camera_from_head.linear();
  HeadAngles angles;
  angles.yaw = DegreesFromRadians(std::atan2(r(0, 2), r(2, 2)));
  angles.pitch = DegreesFromRadians(std::asin(std::clamp(r(1, 2), -1.0, 1.0)));
  angles.roll = DegreesFromRadians(std::atan2(-r(1, 0), r(1, 1)));
  return angles;
}

Result<TryonResult> RunTryon(const TryonRequest& request) {
  TryonResult result;
  result.request = request;
  StageSeconds& seconds = result.seconds;
  const auto start = Clock::now();

  LG_ASSIGN(result.prescription, ReadRxFile(request.rx, request.pd_mm));
  // Frame and light are read side by side.
  auto loading = std::async(std::launch::async,
                            [&] { return LoadFrame(request.frame, request.frame_unit_mm); });
  const bool from_face = request.environment == "face";
  auto light = from_face ? Environment::Constant({1, 1, 1}) : ReadEnvironment(request, result);
  LG_ASSIGN(const FrameModel frame, loading.get());
  LG_ASSIGN(Environment environment, std::move(light));
  LG_ASSIGN(VideoReader reader, VideoReader::Open(request.video));
  VideoWriterOptions writing;
  writing.start_at_first_frame = !request.frames.IsWhole();
  LG_ASSIGN(VideoWriter writer, VideoWriter::Create(request.output, reader, writing));
  result.width = reader.info().width;
  result.height = reader.info().height;
  result.frame_rate = reader.info().frame_rate;
  result.has_audio = reader.info().has_audio;

  HeadTrack track;
  {
    const Timer timer(seconds.track);
    LG_ASSIGN(track, GetTrack(request, reader.info(), result.prescription));
  }
  const bool any = std::any_of(track.frames.begin(), track.frames.end(),
                               [](const TrackedFrame& f) { return f.found; });
  if (!any) return Failure(request.track + ": no frame shows a face");
  result.camera = track.camera;
  result.distortion = track.distortion;
  result.pd_mm = track.pd_mm;
  result.iris_pd_mm = track.iris_pd_mm;
  result.iris_pd_sigma_mm = track.iris_pd_sigma_mm;
  SummarizePoses(track, result);
  if (from_face) {
    LG_ASSIGN(environment, LitLikeTheFace(request, track, result));
  }

  TriangleMesh occluder;
  {
    const Timer timer(seconds.design);
    EyewearOptions options = request.eyewear;
    LG_ASSIGN(options.base_curves, OrderedFronts(request.rx, options.medium.index_d));
    LG_ASSIGN(FittedEyewear fitted,
              FitEyewear(frame, track.face, track.pupil_right, track.pupil_left,
                         result.prescription, request.fit, options));
    const Fit& fit = fitted.fit;
    result.pad_shift_mm = fit.pad_shift_mm;
    result.temple_opening_deg = fit.temple_opening_deg;
    occluder = BuildHeadOccluder(track.face, fit.ears);
    result.eyewear = std::move(fitted.eyewear);
    NoteOrderedFronts(request.rx, options, *result.eyewear);
    Refinish(request.frame_finish, request.frame_color, result.eyewear->frame);
  }
  const auto prepare = [&] {
    const Timer timer(seconds.prepare);
    return Compositor::Create(*result.eyewear, track.face, occluder, environment,
                              request.compositor);
  };
  LG_ASSIGN(Compositor compositor, prepare());
  std::optional<RenderJournal> journal;
  if (request.resume) {
    LG_ASSIGN(journal, RenderJournal::Open(request.output + ".resume", KeyOf(request, track)));
  }
  std::vector<std::pair<std::string, ImageRgb8>> stills;
  {
    Assembly assembly(request, reader, writer, compositor, track, result,
                      journal ? &*journal : nullptr);
    LG_RETURN_IF_ERROR(assembly.Run());
    stills = std::move(assembly.stills());
  }
  {
    const Timer timer(seconds.write);
    LG_RETURN_IF_ERROR(writer.Finish());
    for (const auto& [name, image] : stills) {
      LG_RETURN_IF_ERROR(WritePicture(image, name));
      result.stills.push_back(name);
    }
  }
  if (journal) journal->Remove();
  seconds.wall = std::chrono::duration<double>(Clock::now() - start).count();
  if (!request.oma.empty()) LG_RETURN_IF_ERROR(WriteOmaJob(result));
  if (!request.report.empty()) {
    LG_RETURN_IF_ERROR(WriteFileAtomically(request.report, TryonReportJson(result)));
  }
  return result;
}

}  // namespace lorgnette
