// SPDX-License-Identifier: Apache-2.0
// Rays against the head and the frame, both in head space. The .cc file is the only one that knows
// Embree and its version.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "base/mesh.h"
#include "base/result.h"

namespace lorgnette {

enum class SceneObject : std::uint32_t {
  kFace = 0,
  kOccluder = 1,
  kFrame = 2,
  kNone = 0xffffffffu
};

// The length of a ray that nothing cuts short.
inline constexpr float kEndless = std::numeric_limits<float>::infinity();

// Which objects a ray can meet.
enum class RaySet { kAll, kHead, kFrame };

// Sixteen rays in structure-of-arrays form, laid out as Embree's own packets, which are traced in
// place. After a trace `far` is the distance of the hit, in units of the direction's length.
struct alignas(64) RayPacket {
  static constexpr int kSize = 16;
  float ox[kSize], oy[kSize], oz[kSize], near[kSize];
  float dx[kSize], dy[kSize], dz[kSize];
  float time[kSize] = {};  // of motion blur, which no scene has
  float far[kSize];
  std::uint32_t mask[kSize], id[kSize], flags[kSize] = {};
  float nx[kSize], ny[kSize], nz[kSize];  // the surface's normal, of any length
  float u[kSize], v[kSize];
  std::uint32_t triangle[kSize];
  SceneObject object[kSize];
  std::uint32_t instance[kSize];
  std::int32_t valid[kSize];  // -1: traced, 0: not

  RayPacket() { std::fill_n(mask, kSize, ~0u); }

  template <typename Index>
  void Choose(Index k, bool traced) {
    valid[k] = traced ? -1 : 0;
  }
  // Ray k; whether it is traced is the caller's to choose.
  template <typename Index>
  void Set(Index k, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
           float length = kEndless) {
    ox[k] = origin.x();
    oy[k] = origin.y();
    oz[k] = origin.z();
    near[k] = 0;
    dx[k] = direction.x();
    dy[k] = direction.y();
    dz[k] = direction.z();
    far[k] = length;
  }
};

struct SceneHit {
  SceneObject object = SceneObject::kNone;
  std::uint32_t triangle = 0;
  float distance = 0;
  float u = 0, v = 0;  // weights of the triangle's second and third vertex
  bool hit() const { return object != SceneObject::kNone; }
};

class EmbreeScene {
 public:
  // Any mesh may be empty. Fails when Embree cannot be initialised or runs out of memory.
  static Result<EmbreeScene> Build(const TriangleMesh& face, const TriangleMesh& occluder,
                                   const TriangleMesh& frame);
  EmbreeScene(EmbreeScene&&) noexcept;
  EmbreeScene& operator=(EmbreeScene&&) noexcept;
  ~EmbreeScene();

  // New positions of the face's vertices (as many as at Build); the tree is refitted.
  void MoveFace(const std::vector<Eigen::Vector3f>& vertices);

  // Nearest hit in (near, far); thread safe.
  SceneHit Intersect(RaySet set, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                     float near, float far) const;
  void Intersect16(RaySet set, RayPacket& packet) const;
  // Any hit: sets far[i] < 0 for rays that are blocked and leaves u, v, triangle, object alone. A
  // ray exactly toward the common side of two triangles may pass between them.
  void Occluded16(RaySet set, RayPacket& packet) const;
  bool Occluded(RaySet set, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                float near, float far) const;

 private:
  struct State;
  explicit EmbreeScene(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lorgnette
