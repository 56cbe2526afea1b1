// SPDX-License-Identifier: Apache-2.0
#include "render/lighting.h"

#include <cmath>

#include "base/units.h"

namespace lorgnette {
HeadLight LightAt(const std::vector<Eigen::Vector3f>& directions, const BlurredEnvironment& blurred,
                  const Eigen::Matrix3f& world_from_head, float scale) {
  HeadLight light;
  light.harmonics.fill(Eigen::Vector4f::Zero());
  const float solid_angle = float(4 * kPi) / float(directions.size());
  for (const Eigen::Vector3f& d : directions) {
    const Eigen::Vector3f cell = scale * solid_angle * blurred.Radiance(world_from_head * d);
    const Harmonics h = EvaluateHarmonics(d);
    for (int i = 0; i < kHarmonics; ++i) {
      light.harmonics[std::size_t(i)].head<3>() += h[std::size_t(i)] * cell;
    }
    light.cells.push_back(cell);
  }
  return light;
}

}  // namespace lorgnette
