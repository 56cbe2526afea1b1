// SPDX-License-Identifier: Apache-2.0
#include "apps/track_pipeline.h"

#include <cstdlib>
#include <filesystem>

#include "base/progress.h"
#include "cmake/source_dir.h"
#include "render/video_io.h"
#include "tracking/tracker.h"

namespace lorgnette {

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
  LG_ASSIGN(VideoReader reader, VideoReader::Open(request.video));
  TrackerOptions options;
  options.model_dir = request.model_dir.empty() ? DefaultModelDirectory() : request.model_dir;
  options.pd_mm = request.pd_mm;
  options.focal_px = request.focal_px;
  LG_ASSIGN(Tracker tracker, Tracker::Create(options));
  Progress progress("tracking", "frames", request.frames.Count(reader.info().frame_count));
  long number = 0, taken = 0;
  for (; number <= request.frames.last; ++number) {
    LG_ASSIGN(const std::optional<VideoFrame> frame, reader.Next());
    if (!frame) break;
    if (!request.frames.Contains(number)) continue;
    LG_RETURN_IF_ERROR(tracker.Add(frame->rgb, frame->time_s));
    progress.Update(++taken);
  }
  if (taken == 0) {
    return UsageError("--frames: " + request.video + " has only " + std::to_string(number) +
                      " frames");
  }
  auto track = tracker.Finish();
  if (!track) {
    // The tracker does not know the file's name.
    std::string message = track.error().message;
    if (message.starts_with("video: ")) message = request.video + message.substr(5);
    return tl::unexpected(Error{message, track.error().kind});
  }
  return track;
}

}  // namespace lorgnette
