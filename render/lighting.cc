// SPDX-License-Identifier: Apache-2.0
#include "render/lighting.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "render/visibility.h"

namespace lorgnette {
namespace {

// Points of a packet of origins off their surface, so that float rounding never hides a point
// from itself.
constexpr float kOffSkin_mm = 0.05f;

}  // namespace

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

BakedIrradiance BakedIrradiance::Bake(const EmbreeScene& scene,
                                      const std::vector<SurfacePoint>& points, int directions) {
  BakedIrradiance baked;
  baked.transfer_.resize(points.size());
  baked.head_share_.resize(points.size());
  const std::vector<Eigen::Vector3f> sphere = SphereDirections(directions);
  std::vector<Harmonics> harmonics;
  for (const Eigen::Vector3f& d : sphere) harmonics.push_back(EvaluateHarmonics(d));
  const float solid_angle = float(4 * kPi) / float(directions);
  tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
    const SurfacePoint& p = points[i];
    const Eigen::Vector3f origin = p.position + kOffSkin_mm * p.normal;
    Harmonics& transfer = baked.transfer_[i];
    transfer.fill(0);
    float head = 0, total = 0;
    ForHemispherePackets(sphere, origin, p.normal,
                         [&](std::size_t first, RayPacket& packet, const float* cosine) {
                           RayPacket by_head = packet;
                           scene.Occluded16(RaySet::kFrame, packet);
                           for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
                             by_head.valid[k] = packet.valid[k] && packet.far[k] >= 0;
                           }
                           scene.Occluded16(RaySet::kHead, by_head);
                           for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
                             if (!packet.valid[k]) continue;
                             total += cosine[k];
                             if (packet.far[k] < 0) continue;
                             if (by_head.far[k] < 0) {
                               head += cosine[k];
                               continue;
                             }
                             const Harmonics& h = harmonics[first + k];
                             for (std::size_t j = 0; j < kHarmonics; ++j) {
                               transfer[j] += solid_angle * cosine[k] * h[j];
                             }
                           }
                         });
    // Harmonics of the light already hold one solid angle; orthonormality takes the other.
    baked.head_share_[i] = total > 0 ? head / total : 0;
  });
  return baked;
}

std::vector<Eigen::Vector3f> BakedIrradiance::Relight(const HeadLight& light,
                                                      const Eigen::Vector3f& head_radiance) const {
  std::vector<Eigen::Vector3f> irradiance(transfer_.size());
  const Eigen::Vector3f from_head = float(kPi) * head_radiance;
  constexpr std::size_t kPointsATask = 2048;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, transfer_.size(), kPointsATask),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        Eigen::Vector4f sum = Eigen::Vector4f::Zero();
                        for (std::size_t j = 0; j < kHarmonics; ++j) {
                          sum += transfer_[i][j] * light.harmonics[j];
                        }
                        irradiance[i] = (sum.head<3>() + head_share_[i] * from_head).cwiseMax(0.0f);
                      }
                    });
  return irradiance;
}

}  // namespace lorgnette
