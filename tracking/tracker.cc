// SPDX-License-Identifier: Apache-2.0
#include "tracking/tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "tracking/canonical_mesh.h"
#include "tracking/clip_fit.h"
#include "tracking/face_follower.h"
#include "tracking/track_smoothing.h"

namespace lorgnette {
struct Tracker::State {
  TrackerOptions options;
  CanonicalMesh canonical;
  FaceFollower follower;
  int width = 0, height = 0;
  std::vector<FollowedFrame> frames;
  std::future<void> pictures;  // of the last frame; declared last, since it uses the others

  // Waits for the pictures of the last frame.
  Status Settle() {
    try {
      if (pictures.valid()) pictures.get();
    } catch (const cv::Exception& e) {
      return Failure(
          fmt::format("frame {}: no pictures of the face: {}", frames.size() - 1, e.err));
    }
    return {};
  }
};

Tracker::Tracker(std::unique_ptr<State> state) : state_(std::move(state)) {}
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker::~Tracker() = default;

Result<Tracker> Tracker::Create(const TrackerOptions& options) {
  if (!(options.pd_mm >= kMinPdMm && options.pd_mm <= kMaxPdMm)) {
    return UsageError(fmt::format("pd: got {} mm, want {}..{}", options.pd_mm, kMinPdMm, kMaxPdMm));
  }
  if (!(options.focal_px >= 0 && options.focal_px <= kMaxFocalPx)) {
    return UsageError(fmt::format("focal: got {} px, want 0..{}", options.focal_px, kMaxFocalPx));
  }
  LG_ASSIGN(CanonicalMesh canonical, ReadCanonicalMesh(options.model_dir + "/canonical_face.obj"));
  LG_ASSIGN(FaceFollower follower, FaceFollower::Load(options.model_dir, canonical));
  return Tracker(std::make_unique<State>(
      State{options, std::move(canonical), std::move(follower), 0, 0, {}, {}}));
}

Status Tracker::Add(ImageRgb8 frame, double time_s) {
  State& s = *state_;
  if (frame.empty()) return Failure("frame: got an empty image, want pixels");
  if (s.frames.empty()) {
    s.width = frame.width;
    s.height = frame.height;
    if (const auto& c = s.options.camera; c && (c->width != s.width || c->height != s.height)) {
      return Failure(fmt::format("frame 0: got {}x{}, want {}x{} as the camera", s.width, s.height,
                                 c->width, c->height));
    }
  } else if (frame.width != s.width || frame.height != s.height) {
    return Failure(fmt::format("frame {}: got {}x{}, want {}x{} as the first", s.frames.size(),
                               frame.width, frame.height, s.width, s.height));
  }
  FollowedFrame followed;
  try {
    followed = s.follower.Next(frame, time_s);
  } catch (const cv::Exception& e) {
    return Failure(fmt::format("frame {}: the face network failed: {}", s.frames.size(), e.err));
  }
  LG_RETURN_IF_ERROR(s.Settle());
  s.frames.push_back(std::move(followed));
  s.pictures = std::async(std::launch::async,
                          [&s, number = s.frames.size() - 1, picture = std::move(frame)] {
                            s.follower.KeepPictures(number, picture, s.frames.back());
                          });
  return {};
}

Result<HeadTrack> Tracker::Finish() {
  State& s = *state_;
  LG_RETURN_IF_ERROR(s.Settle());
  std::vector<const FaceLandmarks*> landmarks;
  for (const FollowedFrame& frame : s.frames) {
    landmarks.push_back(frame.landmarks ? &*frame.landmarks : nullptr);
  }
  if (std::count(landmarks.begin(), landmarks.end(), nullptr) == long(landmarks.size())) {
    return Failure(fmt::format("video: no face found in any of {} frames, want at least one",
                               s.frames.size()));
  }
  try {
    s.follower.LookAgain(s.frames);
  } catch (const cv::Exception& e) {
    return Failure(fmt::format("the face network failed: {}", e.err));
  }
  std::optional<Camera> camera = s.options.camera;
  if (!camera && s.options.focal_px > 0) {
    const double f = s.options.focal_px;
    camera = {s.width, s.height, f, f, s.width / 2.0, s.height / 2.0};
  }
  ClipFit fit = FitClip(s.frames, s.canonical, s.width, s.height, s.options.pd_mm, camera);
  std::vector<bool> cut_before;
  for (const FollowedFrame& frame : s.frames) cut_before.push_back(frame.cut_before);
  SmoothTrack(cut_before, fit.confidence, fit.track);
  FollowExpression(landmarks, cut_before, fit.track);
  return std::move(fit.track);
}

}  // namespace lorgnette
