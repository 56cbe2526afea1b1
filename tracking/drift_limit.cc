// SPDX-License-Identifier: Apache-2.0
#include "tracking/drift_limit.h"

namespace lorgnette {

void LimitDrift(const std::vector<Eigen::Isometry3d>& landmark_poses, std::size_t first,
                std::size_t last, bool good_before, bool good_after, double most,
                std::vector<std::optional<PoseFit>>& poses) {
  if (!good_before && !good_after) return;
  const auto error = [&](std::size_t f) {
    return MotionBetween(landmark_poses[f], poses[f]->camera_from_head);
  };
  Vector6d before, after;
  if (good_before) before = error(first - 1);
  if (good_after) after = error(last);
  if (!good_before) before = after;
  if (!good_after) after = before;
  for (std::size_t f = first; f < last; ++f) {
    if (!poses[f]) continue;
    const double share = double(f + 1 - first) / double(last + 1 - first);
    const Eigen::Isometry3d expected =
        Moved(landmark_poses[f], (1 - share) * before + share * after);
    const Vector6d off = MotionBetween(expected, poses[f]->camera_from_head);
    const double turn = off.head<3>().norm();
    // Turn and shift together: they make up for each other in the picture.
    if (turn > most) poses[f]->camera_from_head = Moved(expected, most / turn * off);
  }
}

}  // namespace lorgnette
