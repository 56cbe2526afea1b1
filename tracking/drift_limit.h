// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "tracking/pose_fit.h"

namespace lorgnette {

// Texture followed from frame to frame errs each time a little, and often to the same side: over 20
// frames of a turn of 20 degrees it has lost 10. Landmarks err by a few degrees, and much alike in
// frames near to each other. Holds the poses of the frames first..last-1 within `most` radians of
// the landmarks' pose, corrected as in the frame before and the frame `last` where they are good.
// Does nothing where neither is. Tested.
void LimitDrift(const std::vector<Eigen::Isometry3d>& landmark_poses, std::size_t first,
                std::size_t last, bool good_before, bool good_after, double most,
                std::vector<std::optional<PoseFit>>& poses);

}  // namespace lorgnette
