// SPDX-License-Identifier: Apache-2.0
// A shape that is a function, not triangles, met by rays through Embree (its user geometry). The
// accuracy study measures lenses this way; the renderer traces them without Embree. Implemented in
// embree_scene.cc, which alone knows Embree.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <memory>
#include <optional>

#include "base/result.h"
#include "render/embree_scene.h"

namespace lorgnette {

class EmbreeShape {
 public:
  struct Hit {
    float distance;  // in units of the direction's length
    Eigen::Vector3f normal;
  };
  // Called for one ray at a time; has to be thread safe.
  using Meet = std::function<std::optional<Hit>(const Eigen::Vector3f& origin,
                                                const Eigen::Vector3f& direction)>;
  //   box  holds every hit; rays that miss it are not asked about
  static Result<EmbreeShape> Build(const Eigen::AlignedBox3f& box, Meet meet);
  EmbreeShape(EmbreeShape&&) noexcept;
  EmbreeShape& operator=(EmbreeShape&&) noexcept;
  ~EmbreeShape();

  // As EmbreeScene::Intersect16; `object` becomes kFace where the shape was met, with its normal.
  using Normals = std::array<Eigen::Vector3f, RayPacket::kSize>;
  void Intersect16(RayPacket& packet, Normals& normals) const;

 private:
  struct State;
  explicit EmbreeShape(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lorgnette
