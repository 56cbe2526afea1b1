// SPDX-License-Identifier: Apache-2.0
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <map>

#include "base/units.h"
#include "render/lighting.h"
#include "render/middle_vertices.h"
#include "render/visibility.h"

namespace lorgnette {
namespace {

// Points of a packet of origins off their surface, so that float rounding never hides a point
// from itself.
constexpr float kOffSkin_mm = 0.05f;
// Vertices in the middle take the mean where the two beside them see the same in all but this share
// of the hemisphere's directions.
constexpr float kMostDifference = 0.3f;

// What a vertex sees of the directions: one bit each for what ends in the open, and on the head.
class Views {
 public:
  Views(std::size_t vertices, int directions)
      : words_((std::size_t(directions) + 63) / 64),
        half_(0.5f * float(directions)),
        bits_(2 * words_ * vertices, 0) {}
  enum Kind : std::size_t { kOpen, kHead };
  void Set(std::size_t vertex, Kind kind, std::size_t direction) {
    bits_[(2 * vertex + kind) * words_ + direction / 64] |= std::uint64_t(1) << (direction % 64);
  }
  bool None(std::size_t vertex) const {
    const auto first = bits_.begin() + std::ptrdiff_t(2 * vertex * words_);
    return std::all_of(first, first + std::ptrdiff_t(2 * words_),
                       [](std::uint64_t word) { return word == 0; });
  }
  // Share of the hemisphere's directions in which two vertices differ.
  float Difference(std::size_t a, std::size_t b) const {
    int differ = 0;
    for (std::size_t k = 0; k < 2 * words_; ++k) {
      differ += std::popcount(bits_[2 * a * words_ + k] ^ bits_[2 * b * words_ + k]);
    }
    return float(differ) / half_;
  }

 private:
  std::size_t words_;
  float half_;
  std::vector<std::uint64_t> bits_;
};

}  // namespace

BakedIrradiance BakedIrradiance::Bake(const EmbreeScene& scene, const TriangleMesh& frame,
                                      int directions) {
  BakedIrradiance baked;
  const std::size_t count = frame.positions.size();
  baked.transfer_.resize(count);
  baked.head_share_.resize(count);
  const std::vector<Eigen::Vector3f> sphere = SphereDirections(directions);
  const DirectionColumns columns(sphere);
  std::vector<Harmonics> harmonics;
  for (const Eigen::Vector3f& d : sphere) harmonics.push_back(EvaluateHarmonics(d));
  const float solid_angle = float(4 * kPi) / float(directions);
  Views views(count, directions);
  const auto trace = [&](const std::vector<std::uint32_t>& vertices) {
    tbb::parallel_for(std::size_t(0), vertices.size(), [&](std::size_t at) {
      const std::size_t i = vertices[at];
      const Eigen::Vector3f normal = frame.normals[i].cast<float>();
      const Eigen::Vector3f origin = frame.positions[i].cast<float>() + kOffSkin_mm * normal;
      Harmonics& transfer = baked.transfer_[i];
      transfer.fill(0);
      float head = 0, total = 0;
      ForHemispherePackets(columns, origin, normal,
                           [&](std::size_t first, RayPacket& packet, const float* cosine) {
                             for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
                               if (packet.valid[k]) total += cosine[k];
                             }
                             scene.Occluded16(RaySet::kFrame, packet);
                             // On to the head with those that pass the frame.
                             for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
                               packet.Choose(k, packet.valid[k] && packet.far[k] >= 0);
                             }
                             scene.Occluded16(RaySet::kHead, packet);
                             for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
                               if (!packet.valid[k]) continue;
                               if (packet.far[k] < 0) {
                                 views.Set(i, Views::kHead, first + k);
                                 head += cosine[k];
                                 continue;
                               }
                               views.Set(i, Views::kOpen, first + k);
                               const Harmonics& h = harmonics[first + k];
                               for (std::size_t j = 0; j < kHarmonics; ++j) {
                                 transfer[j] += solid_angle * cosine[k] * h[j];
                               }
                             }
                           });
      // Harmonics of the light already hold one solid angle; orthonormality takes the other.
      baked.head_share_[i] = total > 0 ? head / total : 0;
    });
  };
  const std::vector<MiddleVertex> middles = MiddleVertices(frame);
  std::vector<bool> waits(count, false);
  for (const MiddleVertex& m : middles) waits[m.vertex] = true;
  std::vector<std::uint32_t> now;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!waits[i]) now.push_back(i);
  }
  trace(now);
  now.clear();
  for (const MiddleVertex& m : middles) {
    if (views.None(m.one) || views.None(m.other) ||
        views.Difference(m.one, m.other) > kMostDifference) {
      now.push_back(m.vertex);
      continue;
    }
    for (std::size_t j = 0; j < kHarmonics; ++j) {
      baked.transfer_[m.vertex][j] = (baked.transfer_[m.one][j] + baked.transfer_[m.other][j]) / 2;
    }
    baked.head_share_[m.vertex] = (baked.head_share_[m.one] + baked.head_share_[m.other]) / 2;
    waits[m.vertex] = false;
  }
  trace(now);
  std::vector<bool> buried(count, false);
  for (std::size_t i = 0; i < count; ++i) buried[i] = views.None(i);
  for (const MiddleVertex& m : middles) {
    if (!waits[m.vertex]) buried[m.vertex] = false;
  }
  baked.LightBuried(frame.triangles, std::move(buried));
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
