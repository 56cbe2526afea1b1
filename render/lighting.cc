// SPDX-License-Identifier: Apache-2.0
#include "render/lighting.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

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

BakedIrradiance BakedIrradiance::Bake(const EmbreeScene& scene, const TriangleMesh& frame,
                                      int directions) {
  BakedIrradiance baked;
  const std::size_t count = frame.positions.size();
  baked.transfer_.resize(count);
  baked.head_share_.resize(count);
  std::vector<std::uint8_t> buried(count, 0);
  const std::vector<Eigen::Vector3f> sphere = SphereDirections(directions);
  std::vector<Harmonics> harmonics;
  for (const Eigen::Vector3f& d : sphere) harmonics.push_back(EvaluateHarmonics(d));
  const float solid_angle = float(4 * kPi) / float(directions);
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
    const Eigen::Vector3f normal = frame.normals[i].cast<float>();
    const Eigen::Vector3f origin = frame.positions[i].cast<float>() + kOffSkin_mm * normal;
    Harmonics& transfer = baked.transfer_[i];
    transfer.fill(0);
    float head = 0, total = 0;
    bool any = false;  // way out past the frame
    ForHemispherePackets(sphere, origin, normal,
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
                             any = true;
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
    buried[i] = !any;
  });
  baked.LightBuried(frame.triangles, {buried.begin(), buried.end()});
  return baked;
}

void BakedIrradiance::LightBuried(const std::vector<Eigen::Vector3i>& triangles,
                                  std::vector<bool> buried) {
  // From outside inward, ring by ring of neighbours.
  for (bool found = true; found;) {
    std::map<int, int> neighbours;  // of the buried vertices that are lit in this round
    for (const Eigen::Vector3i& t : triangles) {
      for (int k = 0; k < 3; ++k) {
        if (!buried[std::size_t(t[k])]) continue;
        for (const int other : {t[(k + 1) % 3], t[(k + 2) % 3]}) {
          if (buried[std::size_t(other)]) continue;
          ++neighbours[t[k]];
          const std::size_t to = std::size_t(t[k]), from = std::size_t(other);
          for (std::size_t j = 0; j < kHarmonics; ++j) transfer_[to][j] += transfer_[from][j];
          head_share_[to] += head_share_[from];
        }
      }
    }
    for (const auto& [vertex, count] : neighbours) {
      const std::size_t i = std::size_t(vertex);
      for (float& term : transfer_[i]) term /= float(count);
      head_share_[i] /= float(count);
      buried[i] = false;
    }
    found = !neighbours.empty();
  }
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
