// SPDX-License-Identifier: Apache-2.0
// Which directions the head itself hides from the face: traced at the vertices of its mesh, and
// known at the points between them where the vertices agree. Internal to render/.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "base/mesh.h"
#include "render/embree_scene.h"
#include "render/visibility.h"

namespace lorgnette {

class FaceViews {
 public:
  //   face  with normals;  directions  how many there are, all over the sphere
  FaceViews(const TriangleMesh& face, std::size_t directions);

  // Traces a vertex, if it has not been; before anything is asked of it. Thread safe.
  void Prepare(const EmbreeScene& scene, const DirectionColumns& directions, std::size_t vertex);

  enum class View : std::uint8_t { kOpen, kHidden, kUnknown };
  // From a vertex; unknown below its surface.
  View FromVertex(std::size_t vertex, std::size_t direction) const {
    const std::size_t word = vertex * words_ + direction / 64;
    const std::uint64_t bit = std::uint64_t(1) << (direction % 64);
    if ((hidden_[word] & bit) != 0) return View::kHidden;
    return (open_[word] & bit) != 0 ? View::kOpen : View::kUnknown;
  }
  // From within a triangle; unknown where its corners do not agree.
  View FromTriangle(const Eigen::Vector3i& corners, std::size_t direction) const {
    const View view = FromVertex(std::size_t(corners[0]), direction);
    const bool same = FromVertex(std::size_t(corners[1]), direction) == view &&
                      FromVertex(std::size_t(corners[2]), direction) == view;
    return same ? view : View::kUnknown;
  }

 private:
  std::size_t words_;  // a vertex
  std::vector<Eigen::Vector3f> origins_, normals_;
  std::unique_ptr<std::once_flag[]> once_;    // one a vertex
  std::vector<std::uint64_t> open_, hidden_;  // a bit a direction
};

}  // namespace lorgnette
