// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "tracking/head_track.h"

namespace lorgnette {

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

}  // namespace lorgnette
