// SPDX-License-Identifier: Apache-2.0
// What happens to a track after every frame has its pose: smoothing in time, and the face's
// expression on top of the rigid pose.
#pragma once

#include <vector>

#include "tracking/face_landmarker.h"
#include "tracking/head_track.h"

namespace lorgnette {

// Smooths camera_from_head over runs of frames with a face, never across a gap or a cut; forward
// and backward agree and nothing lags (tracking/smoothing.h).
//   cut_before  one a frame: the film was cut between it and the frame before
//   confidence  one a frame, 0..1: how far its pose can be relied on
void SmoothTrack(const std::vector<bool>& cut_before, const std::vector<double>& confidence,
                 HeadTrack& track);

// Fills `vertices` and `residual_px` of every frame with a face: each vertex moves, at the depth of
// the rigid face, to where the landmark is seen; the moves are smoothed in time.
//   landmarks  one a frame, null where there is no face
void FollowExpression(const std::vector<const FaceLandmarks*>& landmarks,
                      const std::vector<bool>& cut_before, HeadTrack& track);

}  // namespace lorgnette
