// SPDX-License-Identifier: Apache-2.0
// The frames of a clip, read, drawn upon and written in order, the three overlapping.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/camera_choice.h"
#include "apps/render_journal.h"
#include "apps/track_lookup.h"
#include "apps/tryon_pipeline.h"
#include "base/progress.h"
#include "geometry/face_motion.h"
#include "render/compositor.h"
#include "render/video_io.h"

namespace lorgnette {

class FrameAssembly {
 public:
  // Everything has to outlive it. `result` holds the eyewear, and takes counts and seconds.
  //   journal  of what an earlier run drew; null: none
  FrameAssembly(const TryonRequest& request, VideoReader& reader, VideoWriter& writer,
                Compositor& compositor, const HeadTrack& track, TryonResult& result,
                RenderJournal* journal);

  // The frames of the request's range; leaves the writer to be finished.
  Status Run();
  // By file name, to be written after the video.
  std::vector<std::pair<std::string, ImageRgb8>> TakeStills() { return std::move(stills_); }

 private:
  // One frame on its way.
  struct Job {
    VideoFrame frame;
    const TrackedFrame* tracked = nullptr;
    ImageRgb8 input;  // as read, of stills that show it
  };

  // The next frame of the range; nullptr at the end, or after an error.
  std::shared_ptr<Job> Read();
  void Render(Job& job);
  void Write(Job& job);
  void Count(const FrameTally& tally);
  bool IsStill(const Job& job) const;
  void KeepStill(const Job& job);
  std::nullptr_t Fail(const Error& error);

  const TryonRequest& request_;
  VideoReader& reader_;
  VideoWriter& writer_;
  Compositor& compositor_;
  const HeadTrack& track_;
  FaceMotion motion_;
  TrackLookup lookup_;
  std::vector<long> chosen_;  // stills
  TryonResult& result_;
  RenderJournal* journal_;
  std::optional<PictureRectifier> rectifier_;
  Progress progress_;
  long number_ = 0;
  bool exposed_ = false;
  std::atomic<bool> failed_ = false;
  Status status_;
  std::vector<std::pair<std::string, ImageRgb8>> stills_;
};

}  // namespace lorgnette
