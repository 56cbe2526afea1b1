// SPDX-License-Identifier: Apache-2.0
// A lens surface as the graph z = sag(x, y) over its vertex tangent plane: value, gradient and
// second derivatives in closed form, and a ray intersection that is stable from plano to steep.
//
// Curvature is stored, never a radius (plano is 0); positive when the centre of curvature is on
// the eye side (+z). Coordinates are the surface's own: origin at its vertex, axes those of the
// lens frame (optics/ray.h). Source: docs/optics.md, "Surfaces".
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <optional>
#include <utility>
#include <variant>

#include "optics/ray.h"
#include "optics/surface_shapes.h"

namespace lorgnette {

// Where a ray meets the surface.
struct SurfaceHit {
  double distance = 0;              // along the ray, mm; may be negative (behind the origin)
  Eigen::Vector3d point{0, 0, 0};   // mm, in the surface's frame
  Eigen::Vector3d normal{0, 0, 0};  // unit, toward +z
};

class Surface {
 public:
  using Shape = std::variant<SphereSurface, TorusSurface, ConicSurface, AtoroidSurface,
                             ProgressiveSurface, BifocalSurface, GridSurface>;
  Surface() = default;
  template <typename S>
  requires std::constructible_from<Shape, S> &&
      (!std::same_as<std::remove_cvref_t<S>, Surface>)explicit(false) Surface(S shape)
      : shape_(std::move(shape)) {}
  const Shape& shape() const { return shape_; }

  // nullopt where the surface does not exist (|c| h > 1 and the like), and for no other reason.
  std::optional<SurfaceJet> Jet(double x, double y) const;
  // First-sheet intersection (the sheet that holds the vertex); nullopt when the ray misses it.
  std::optional<SurfaceHit> Intersect(const Ray& ray) const;
  // Curvature at the vertex as the symmetric matrix [zxx zxy; zxy zyy], 1/mm.
  Eigen::Matrix2d VertexCurvature() const;

 private:
  Shape shape_ = SphereSurface{};
};

}  // namespace lorgnette
