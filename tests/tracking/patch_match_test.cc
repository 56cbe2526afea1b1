// SPDX-License-Identifier: Apache-2.0
#include "tracking/patch_match.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace lorgnette {
namespace {

// A smooth random-looking texture, continuous in the plane.
double Texture(double x, double y) {
  return std::sin(0.55 * x + 0.2 * y) + std::sin(0.31 * y - 0.42 * x + 1) +
         std::sin(0.23 * x + 0.61 * y + 2);
}

// The texture seen under the map `texture_from_picture`.
Image<std::uint8_t, 1> Picture(const Eigen::Matrix2d& map, const Eigen::Vector2d& shift) {
  Image<std::uint8_t, 1> image(128, 128);
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      const Eigen::Vector2d p = map * Eigen::Vector2d(x + 0.5, y + 0.5) + shift;
      *image.at(x, y) = std::uint8_t(std::lround(128 + 30 * Texture(p.x(), p.y())));
    }
  }
  return image;
}

const Eigen::Matrix2d kIdentity = Eigen::Matrix2d::Identity();
const Eigen::Vector2d kCentre(60.5, 64);

TEST(PatchTemplate, FindsAShiftToATwentiethOfAPixel) {
  const TexturePyramid here(Picture(kIdentity, {0, 0}));
  const Eigen::Vector2d shift(2.3, -1.65);
  const TexturePyramid there(Picture(kIdentity, -shift));
  const auto patch = PatchTemplate::Cut(here.levels[0], kCentre);
  ASSERT_TRUE(patch);
  const auto match = patch->Find(there.levels[0], kCentre, kIdentity, 6);
  ASSERT_TRUE(match);
  EXPECT_LT((match->position - kCentre - shift).norm(), 0.05);
  EXPECT_GT(match->correlation, 0.98);
}

TEST(PatchTemplate, FollowsALinearMap) {
  Eigen::Matrix2d other_from_here;
  other_from_here << 0.9, 0.1, -0.05, 1.05;
  const Eigen::Matrix2d back = other_from_here.inverse();
  const TexturePyramid here(Picture(kIdentity, {0, 0}));
  // The point kCentre stays where it is.
  const TexturePyramid there(Picture(back, kCentre - back * kCentre));
  const auto patch = PatchTemplate::Cut(here.levels[0], kCentre);
  ASSERT_TRUE(patch);
  const auto match =
      patch->Find(there.levels[0], kCentre + Eigen::Vector2d(1, 1), other_from_here, 6);
  ASSERT_TRUE(match);
  // The normalisation by square surroundings differs a little under the map.
  EXPECT_LT((match->position - kCentre).norm(), 0.15);
}

TEST(PatchTemplate, IsNotCutAtTheBorderOrFromBlankSkin) {
  const TexturePyramid texture(Picture(kIdentity, {0, 0}));
  EXPECT_FALSE(PatchTemplate::Cut(texture.levels[0], {5, 64}));
  EXPECT_FALSE(PatchTemplate::Cut(texture.levels[0], {64, 125}));
  Image<std::uint8_t, 1> blank(128, 128);
  EXPECT_FALSE(PatchTemplate::Cut(TexturePyramid(blank).levels[0], kCentre));
}

TEST(PatchTemplate, RefusesToLeaveItsReach) {
  const TexturePyramid here(Picture(kIdentity, {0, 0}));
  const TexturePyramid there(Picture(kIdentity, {-3, 0}));
  const auto patch = PatchTemplate::Cut(here.levels[0], kCentre);
  ASSERT_TRUE(patch);
  EXPECT_FALSE(patch->Find(there.levels[0], kCentre, kIdentity, 1));
  EXPECT_FALSE(patch->Find(there.levels[0], {2, 2}, kIdentity, 6));
  EXPECT_FALSE(patch->Find(there.levels[0], kCentre, Eigen::Matrix2d::Zero(), 6));
}

}  // namespace
}  // namespace lorgnette
