// SPDX-License-Identifier: Apache-2.0
// Rays by the batch: columns for the lens kernel, bundles for the scene. Private to render/.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "optics/lens_kernel.h"
#include "render/embree_scene.h"

namespace lorgnette {

// Storage behind RayArrays.
struct RayColumns {
  std::array<std::vector<float>, 6> columns;
  void Resize(std::size_t n) {
    for (auto& c : columns) c.resize(n);
  }
  RayArrays<float> view() {
    return {columns[0].data(), columns[1].data(), columns[2].data(),
            columns[3].data(), columns[4].data(), columns[5].data()};
  }
  RayArrays<const float> const_view() const {
    return {columns[0].data(), columns[1].data(), columns[2].data(),
            columns[3].data(), columns[4].data(), columns[5].data()};
  }
  Eigen::Vector3f point(std::size_t i) const {
    return {columns[0][i], columns[1][i], columns[2][i]};
  }
  Eigen::Vector3f vector(std::size_t i) const {
    return {columns[3][i], columns[4][i], columns[5][i]};
  }
  void Set(std::size_t i, const Eigen::Vector3f& p, const Eigen::Vector3f& d) {
    for (std::size_t k = 0; k < 3; ++k) {
      columns[k][i] = p[Eigen::Index(k)];
      columns[k + 3][i] = d[Eigen::Index(k)];
    }
  }
};

// Rays of head space, traced in packets against the scene.
struct RayBundle {
  std::vector<Eigen::Vector3f> origins, directions;
  std::vector<float> far;  // in: length; unused entries are absent, not masked
  std::vector<SceneHit> hits;

  void Clear() {
    origins.clear();
    directions.clear();
    far.clear();
  }
  void Add(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
           float length = kEndless) {
    origins.push_back(origin);
    directions.push_back(direction);
    far.push_back(length);
  }
  // n rays, each to be Set.
  void Resize(std::size_t n) {
    origins.resize(n);
    directions.resize(n);
    far.resize(n);
  }
  void Set(std::size_t i, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
           float length = kEndless) {
    origins[i] = origin;
    directions[i] = direction;
    far[i] = length;
  }
  void Fill(std::size_t first, RayPacket& packet) const {
    const std::size_t n = origins.size();
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      const std::size_t i = std::min(first + k, n - 1);
      packet.Choose(k, first + k < n);
      packet.Set(k, origins[i], directions[i], far[i]);
    }
  }
  // Fills `hits`, one a ray.
  void Trace(const EmbreeScene& scene, RaySet set) {
    const std::size_t n = origins.size();
    hits.assign(n, SceneHit{});
    RayPacket packet;
    for (std::size_t first = 0; first < n; first += RayPacket::kSize) {
      Fill(first, packet);
      scene.Intersect16(set, packet);
      for (std::size_t k = 0; k < RayPacket::kSize && first + k < n; ++k) {
        if (packet.object[k] == SceneObject::kNone) continue;
        hits[first + k] = {packet.object[k], packet.triangle[k], packet.far[k], packet.u[k],
                           packet.v[k]};
      }
    }
  }
};

}  // namespace lorgnette
