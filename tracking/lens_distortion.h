// SPDX-License-Identifier: Apache-2.0
// What a real camera lens does to the pinhole's picture, and pictures freed from it.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "base/camera.h"
#include "base/image.h"

namespace lorgnette {

// Radial (k1, k2, k3) and decentring (p1, p2) terms on ideal positions (x/z, y/z) of camera space,
// in OpenCV's order and sense. Source: Brown 1966, Photogrammetric Engineering 32(3).
struct LensDistortion {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;

  bool IsNone() const { return k1 == 0 && k2 == 0 && p1 == 0 && p2 == 0 && k3 == 0; }
  // Where the lens puts an ideal position.
  Eigen::Vector2d Distorted(const Eigen::Vector2d& ideal) const;
  // The ideal position of a distorted one, by Newton's steps from it. nullopt where the model folds
  // back, so that there is none. Tested: inverse of Distorted() to 1e-12.
  std::optional<Eigen::Vector2d> Ideal(const Eigen::Vector2d& distorted) const;
};

// Pictures of one size between the real camera and the pinhole of the same matrix.
class PictureRectifier {
 public:
  PictureRectifier(const Camera& camera, const LensDistortion& distortion);
  PictureRectifier(PictureRectifier&&) noexcept;
  PictureRectifier& operator=(PictureRectifier&&) noexcept;
  ~PictureRectifier();

  // As the pinhole would have seen it (bicubic); black where the frame does not reach.
  ImageRgb8 Rectified(const ImageRgb8& frame) const;
  // `frame` with what was changed from `rectified` to `changed`, bent back as the lens bends it;
  // every pixel that no change touches stays as it is.
  ImageRgb8 WithChanges(const ImageRgb8& frame, const ImageRgb8& rectified,
                        const ImageRgb8& changed) const;

 private:
  struct Maps;
  std::unique_ptr<Maps> maps_;
};

}  // namespace lorgnette
