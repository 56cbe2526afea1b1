// SPDX-License-Identifier: Apache-2.0
// A cut lens as a closed solid of glass: two analytic surfaces and the edge wall, which is parallel
// to the lens axis through the contour. In double, in the lens frame (optics/ray.h).
//
// This is the exact path of every ray that the compositor follows through glass one at a time: the
// edge, internal reflection, the hit map. Tested: a ray that enters by the front and leaves by the
// back is TraceThrough's to 1e-12 mm; every ray inside leaves; entering and leaving alternate.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "optics/lens.h"
#include "optics/ray.h"
#include "render/contour_index.h"

namespace lorgnette {

enum class SolidFace { kFront, kBack, kWall };

struct SolidHit {
  SolidFace face = SolidFace::kFront;
  double distance = 0;     // mm along the ray
  Eigen::Vector3d point;   // lens frame
  Eigen::Vector3d normal;  // unit, out of the glass
};

class LensSolid {
 public:
  // contour_mm: closed polygon in the lens frame's x, y, inside both surfaces' domain.
  LensSolid(const Lens& lens, const std::vector<Eigen::Vector2d>& contour_mm,
            const Eigen::Isometry3d& head_from_lens);

  const Lens& lens() const { return lens_; }
  const ContourIndex& contour() const { return contour_; }
  const Eigen::Isometry3d& head_from_lens() const { return head_from_lens_; }
  const Eigen::Isometry3d& lens_from_head() const { return lens_from_head_; }
  // Box around the glass, lens frame.
  const Eigen::Vector3d& low() const { return low_; }
  const Eigen::Vector3d& high() const { return high_; }

  // Whether the back surface nowhere curves away from the glass, as on every meniscus: a ray inside
  // that leaves it does not meet it again.
  bool back_bulges_inward() const { return back_bulges_inward_; }

  // First point of the glass on a ray that starts outside, beyond kStart_mm.
  std::optional<SolidHit> Enter(const Ray& ray) const;
  // Where a ray that starts inside (or on the boundary, heading in) meets the boundary.
  std::optional<SolidHit> Leave(const Ray& ray) const;

  // A ray that starts on the boundary leaves it behind within this length.
  static constexpr double kStart_mm = 1e-7;

 private:
  std::optional<SolidHit> CrossFace(SolidFace face, const Ray& ray, double t_max) const;
  std::optional<double> FaceHeight(SolidFace face, double x, double y) const;

  Lens lens_;
  ContourIndex contour_;
  Eigen::Isometry3d head_from_lens_, lens_from_head_;
  Eigen::Matrix3d back_rotation_;
  bool back_tilted_ = false;
  bool back_bulges_inward_ = false;
  Eigen::Vector3d low_, high_;
};

}  // namespace lorgnette
