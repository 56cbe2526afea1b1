// SPDX-License-Identifier: Apache-2.0
// Tracks the face of a video, with progress on standard error.
#pragma once

#include <string>

#include "apps/frame_range.h"
#include "base/result.h"
#include "tracking/head_track.h"

namespace lorgnette {

struct TrackRequest {
  std::string video;
  std::string model_dir;  // empty: DefaultModelDirectory()
  FrameRange frames;
  double pd_mm = 64;
  double focal_px = 0;  // 0: estimated
  std::string camera;   // camera file; empty: not calibrated
};

// One TrackedFrame for each frame of the range, in order.
Result<HeadTrack> TrackVideo(const TrackRequest& request);

// $LORGNETTE_MODELS; else cache/models above the program's folder; else that of the source tree.
std::string DefaultModelDirectory();

}  // namespace lorgnette
