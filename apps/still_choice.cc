// SPDX-License-Identifier: Apache-2.0
#include "apps/still_choice.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "apps/tryon_pipeline.h"

namespace lorgnette {

std::vector<long> ChooseStills(const HeadTrack& track, int count) {
  std::vector<long> found;
  long most_turned = -1;
  double greatest_yaw = -1;
  for (long i = 0; i < static_cast<long>(track.frames.size()); ++i) {
    const TrackedFrame& frame = track.frames[i];
    if (!frame.found) continue;
    found.push_back(i);
    const double yaw = std::abs(AnglesOf(frame.camera_from_head).yaw);
    if (yaw > greatest_yaw) {
      greatest_yaw = yaw;
      most_turned = i;
    }
  }
  if (count <= 0 || found.empty()) return {};
  std::set<long> chosen;
  const long last = static_cast<long>(found.size()) - 1;
  for (int i = 0; i < count; ++i) {
    // The middle of each of `count` equal parts.
    chosen.insert(found[std::lround((i + 0.5) / count * static_cast<double>(last))]);
  }
  if (!chosen.contains(most_turned)) {
    const auto nearest = std::min_element(chosen.begin(), chosen.end(), [&](long a, long b) {
      return std::abs(a - most_turned) < std::abs(b - most_turned);
    });
    chosen.erase(nearest);
    chosen.insert(most_turned);
  }
  return {chosen.begin(), chosen.end()};
}

}  // namespace lorgnette
