// SPDX-License-Identifier: Apache-2.0
#include "apps/tryon_pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>

#include "apps/frame_assembly.h"
#include "apps/oma_export.h"
#include "apps/program.h"
#include "apps/render_journal.h"
#include "apps/rx_file.h"
#include "apps/stage_timer.h"
#include "apps/track_lookup.h"
#include "apps/track_pipeline.h"
#include "apps/tryon_report.h"
#include "base/atomic_file.h"
#include "geometry/frame_io.h"
#include "geometry/head_occluder.h"
#include "render/color.h"
#include "render/environment.h"
#include "render/face_light.h"
#include "render/image_io.h"
#include "render/video_io.h"

namespace lorgnette {
namespace {

constexpr double kPdAgreement_mm = 0.05;

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
  const auto start = std::chrono::steady_clock::now();

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
    const StageTimer timer(seconds.track);
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
    const StageTimer timer(seconds.design);
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
    const StageTimer timer(seconds.prepare);
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
    FrameAssembly assembly(request, reader, writer, compositor, track, result,
                           journal ? &*journal : nullptr);
    LG_RETURN_IF_ERROR(assembly.Run());
    stills = assembly.TakeStills();
  }
  {
    const StageTimer timer(seconds.write);
    LG_RETURN_IF_ERROR(writer.Finish());
    for (const auto& [name, image] : stills) {
      LG_RETURN_IF_ERROR(WritePicture(image, name));
      result.stills.push_back(name);
    }
  }
  if (journal) journal->Remove();
  seconds.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!request.oma.empty()) LG_RETURN_IF_ERROR(WriteOmaJob(result));
  if (!request.report.empty()) {
    LG_RETURN_IF_ERROR(WriteFileAtomically(request.report, TryonReportJson(result)));
  }
  return result;
}

}  // namespace lorgnette
