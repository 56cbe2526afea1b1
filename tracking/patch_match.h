// SPDX-License-Identifier: Apache-2.0
// Small patches of skin found again in another picture of the same face, to a fraction of a pixel.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "base/image.h"

namespace lorgnette {

// A grey picture with light and shade divided out: every pixel less the mean of its surroundings,
// over their deviation. Two levels, the second at half size. Level positions count from pixel
// centres: index i is position i + 0.5 of its own level.
struct TexturePyramid {
  static constexpr int kLevels = 2;
  std::array<Image<float, 1>, kLevels> levels;
  explicit TexturePyramid(const Image<std::uint8_t, 1>& grey);
  TexturePyramid() = default;
  bool empty() const { return levels[0].empty(); }
};

// A square patch of one level: values and gradients.
class PatchTemplate {
 public:
  static constexpr int kRadius = 8;  // px
  static constexpr int kStep = 2;    // px between samples: 9 x 9 of them
  // nullopt when the patch leaves the picture or has too little texture in one direction.
  static std::optional<PatchTemplate> Cut(const Image<float, 1>& level,
                                          const Eigen::Vector2d& centre);

  struct Match {
    Eigen::Vector2d position;  // of the patch's centre, in the other picture's level
    double correlation;        // -1..1
  };
  // Looks for the patch near `guess` in another picture, in which it appears under the linear map
  // `other_from_patch`. nullopt when the search leaves the picture, does not settle, or moves
  // further than `reach_px`. (Lucas and Kanade 1981, inverse form of Baker and Matthews 2004.)
  // Tested: finds a shift of three pixels to a twentieth of a pixel.
  std::optional<Match> Find(const Image<float, 1>& level, const Eigen::Vector2d& guess,
                            const Eigen::Matrix2d& other_from_patch, double reach_px) const;

  // Smaller eigenvalue of the mean gradient matrix: how well the patch fixes both directions.
  double strength() const { return strength_; }

 private:
  static constexpr int kSide = 2 * kRadius / kStep + 1;
  static constexpr int kSamples = kSide * kSide;
  std::array<float, kSamples> value_, dx_, dy_;
  Eigen::Matrix2d structure_;  // sum of gradient * gradient^T
  double strength_ = 0;
};

}  // namespace lorgnette
