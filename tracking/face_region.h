// SPDX-License-Identifier: Apache-2.0
// The turned square of the image that the landmark network looks at.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/image.h"

namespace lorgnette {

struct FaceRegion {
  Eigen::Vector2d centre{0, 0};  // px
  double side = 0;               // px
  double angle = 0;              // radians, of the region's x axis in the image (y down)

  // Image position of (u, v) in [0, 1]^2 of the region, and back.
  Eigen::Vector2d ToImage(const Eigen::Vector2d& uv) const;
  Eigen::Vector2d FromImage(const Eigen::Vector2d& px) const;
};

// The square, 1.5 times as wide as the points' extent, upright along the line from `right_eye` to
// `left_eye` (the wearer's). Source: MediaPipe's face landmark graph.
FaceRegion RegionAround(const std::vector<Eigen::Vector2d>& points,
                        const Eigen::Vector2d& right_eye, const Eigen::Vector2d& left_eye);

// `pixels` x `pixels` samples of the region; black outside the image; shrunk by area so that fine
// detail does not alias into the network's input.
ImageRgb8 SampleRegion(const ImageRgb8& frame, const FaceRegion& region, int pixels);
Image<std::uint8_t, 1> SampleGrey(const ImageRgb8& frame, const FaceRegion& region, int pixels);

}  // namespace lorgnette
