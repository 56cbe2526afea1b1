// SPDX-License-Identifier: Apache-2.0
// Which frames of a clip to keep as stills.
#pragma once

#include <vector>

#include "tracking/head_track.h"

namespace lorgnette {

// Indices into track.frames, ascending, without repetition, at most `count`: spread evenly over the
// frames that show a face, with the one whose head is turned most in place of its neighbour.
std::vector<long> ChooseStills(const HeadTrack& track, int count);

}  // namespace lorgnette
