// SPDX-License-Identifier: Apache-2.0
#include "apps/track_pipeline.h"

#include <cstdlib>
#include <filesystem>
#include <thread>

#include "apps/camera_choice.h"
#include "apps/frame_queue.h"
#include "base/progress.h"
#include "cmake/source_dir.h"
#include "render/video_io.h"
#include "tracking/tracker.h"

namespace lorgnette {
namespace {

constexpr std::size_t kFramesReadAhead = 4;

// Decodes the frames of a range (and rectifies them) on a thread of its own.
class DecodingThread {
 public:
  DecodingThread(VideoReader& reader, const FrameRange& range,
                 const std::optional<PictureRectifier>& rectifier)
      : queue_(kFramesReadAhead), thread_([this, &reader, &range, &rectifier] {
          for (; number_ <= range.last; ++number_) {
            auto frame = reader.Next();
            if (!frame) {
              status_ = tl::unexpected(frame.error());
              break;
            }
            if (!*frame) break;
            if (!range.Contains(number_)) continue;
            if (rectifier) (*frame)->rgb = rectifier->Rectified((*frame)->rgb);
            if (!queue_.Push(**std::move(frame))) break;
          }
          queue_.End();
        }) {}
  ~DecodingThread() {
    queue_.Close();
    if (thread_.joinable()) thread_.join();
  }
  DecodingThread(const DecodingThread&) = delete;
  DecodingThread& operator=(const DecodingThread&) = delete;

  std::optional<VideoFrame> Next() { return queue_.Pop(); }
  // After the last frame: whether the video ended well, and how many frames were read.
  Status Finish() {
    thread_.join();
    return status_;
  }
  long number() const { return number_; }

 private:
  FrameQueue<VideoFrame> queue_;
  Status status_;
  long number_ = 0;
  std::thread thread_;  // last: it uses the others
};

}  // namespace

std::string DefaultModelDirectory() {
  namespace fs = std::filesystem;
  if (const char* chosen = std::getenv("LORGNETTE_MODELS"); chosen != nullptr) return chosen;
  std::error_code ec;
  fs::path folder = fs::read_symlink("/proc/self/exe", ec).parent_path();
  for (; !folder.empty() && folder != folder.root_path(); folder = folder.parent_path()) {
    if (fs::is_directory(folder / "cache" / "models", ec)) {
      return (folder / "cache" / "models").string();
    }
  }
  return LORGNETTE_SOURCE_DIR "/cache/models";
}

Result<HeadTrack> TrackVideo(const TrackRequest& request) {
  LG_ASSIGN(VideoReader reader,
            VideoReader::Open(request.video, {.keep_originals = false, .exact_colours = false}));
  TrackerOptions options;
  options.model_dir = request.model_dir.empty() ? DefaultModelDirectory() : request.model_dir;
  options.pd_mm = request.pd_mm;
  options.focal_px = request.focal_px;
  LG_ASSIGN(const std::optional<CalibratedCamera> camera,
            CameraForVideo(request.camera, reader.info().width, reader.info().height));
  std::optional<PictureRectifier> rectifier;
  if (camera) {
    options.camera = camera->camera;
    rectifier = RectifierFor(camera->camera, camera->distortion);
  }
  DecodingThread decoding(reader, request.frames, rectifier);  // while the networks are loaded
  LG_ASSIGN(Tracker tracker, Tracker::Create(options));
  Progress progress("tracking", "frames", request.frames.Count(reader.info().frame_count));
  long taken = 0;
  while (std::optional<VideoFrame> frame = decoding.Next()) {
    LG_RETURN_IF_ERROR(tracker.Add(std::move(frame->rgb), frame->time_s));
    progress.Update(++taken);
  }
  LG_RETURN_IF_ERROR(decoding.Finish());
  if (taken == 0) {
    return UsageError("--frames: " + request.video + " has only " +
                      std::to_string(decoding.number()) + " frames");
  }
  auto track = tracker.Finish();
  if (!track) {
    // The tracker does not know the file's name.
    std::string message = track.error().message;
    if (message.starts_with("video: ")) message = request.video + message.substr(5);
    return tl::unexpected(Error{message, track.error().kind});
  }
  if (camera) track->distortion = camera->distortion;
  return track;
}

}  // namespace lorgnette
