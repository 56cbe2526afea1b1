// SPDX-License-Identifier: Apache-2.0
// Follows a face through a clip: one detection, then landmark-driven regions; afterwards a personal
// mesh, the focal length and smoothed poses are fitted over the whole clip.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/camera.h"
#include "base/image.h"
#include "base/result.h"
#include "tracking/head_track.h"

namespace lorgnette {

inline constexpr double kMinPdMm = 40, kMaxPdMm = 90;
inline constexpr double kMaxFocalPx = 1e6;

struct TrackerOptions {
  std::string model_dir;  // folder with the converted networks and the canonical mesh
  double pd_mm = 64;      // scale: distance between the pupils, kMinPdMm..kMaxPdMm
  double focal_px = 0;    // 0: from the clip, as far as it tells (tracking/focal_prior.h)
  std::optional<Camera> camera =
      std::nullopt;  // calibrated, of the frames' size; wins over focal_px
};

class Tracker {
 public:
  static Result<Tracker> Create(const TrackerOptions& options);
  Tracker(Tracker&&) noexcept;
  ~Tracker();

  // Frames in order, all of one size. A second thread cuts its pictures out of a frame while the
  // network looks at the next.
  Status Add(ImageRgb8 frame, double time_s);
  // Fails with one sentence when no frame shows a face.
  Result<HeadTrack> Finish();

 private:
  struct State;
  explicit Tracker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lorgnette
