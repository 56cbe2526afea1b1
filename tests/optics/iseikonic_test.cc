// SPDX-License-Identifier: Apache-2.0
#include "optics/iseikonic.h"

#include <gtest/gtest.h>

#include "optics/magnification.h"

namespace lorgnette {
namespace {

IseikonicOrder Anisometropia() {
  IseikonicOrder order;
  order.right = {Diopters(-1), 16, Diopters(6), 2};
  order.left = {Diopters(-3), 16, Diopters(4), 2};
  return order;
}

TEST(DesignIseikonicPair, MakesBothLensesMagnifyAlike) {
  const auto pair = DesignIseikonicPair(Anisometropia());
  ASSERT_TRUE(pair) << pair.error().message;
  EXPECT_NEAR(pair->ratio, 1, 1e-12);
  EXPECT_GT(pair->ratio_before, 1.02);
  // The weaker minus magnifies more and stays; the other one grows in base curve and thickness.
  EXPECT_EQ(pair->right.thickness_mm, 2);
  EXPECT_GT(pair->left.base_curve.value(), 4);
  EXPECT_GT(pair->left.thickness_mm, 2);
  EXPECT_NEAR(pair->left.base_curve.value() / 4, pair->left.thickness_mm / 2, 1e-12);
}

TEST(DesignIseikonicPair, KeepsThePowersAndIsConfirmedByRays) {
  const IseikonicOrder order = Anisometropia();
  const auto pair = DesignIseikonicPair(order);
  ASSERT_TRUE(pair);
  double seen[2];
  int k = 0;
  for (const auto& [made, eye] : {std::pair{pair->right, order.right}, {pair->left, order.left}}) {
    const auto system =
        ParaxialSystem::ThickLens(made.base_curve, made.back_power, made.thickness_mm, order.index);
    EXPECT_NEAR(system.BackVertexPower().value(), eye.back_vertex_power.value(), 1e-13);
    EXPECT_NEAR(SpectacleMagnification(system, eye.pupil_mm), made.magnification, 1e-14);
    Lens lens;
    lens.front = Surface(SphereSurface{made.base_curve.value() / (1000 * (order.index - 1))});
    lens.back = Surface(SphereSurface{made.back_power.value() / (1000 * (1 - order.index))});
    lens.center_thickness_mm = made.thickness_mm;
    // Seen from afar the pupil is magnified as the world is for its owner.
    const auto ray = ObserverExact(lens, order.index, {1e7, eye.pupil_mm}, {0.1, 0});
    ASSERT_TRUE(ray);
    seen[k++] = ray->magnification;
  }
  // At 10 km, 0.1 mm off the axis: (h c)^2 ~ 1e-5 of a few per cent, and rounding of 1e7 mm.
  EXPECT_NEAR(seen[0] / seen[1], 1, 1e-6);
}

TEST(DesignIseikonicPair, ReachesAWantedDifferenceToo) {
  IseikonicOrder order = Anisometropia();
  order.ratio = 0.99;
  const auto pair = DesignIseikonicPair(order);
  ASSERT_TRUE(pair) << pair.error().message;
  EXPECT_NEAR(pair->ratio, 0.99, 1e-12);
}

TEST(DesignIseikonicPair, SaysWhatIsPossibleWhenTheLimitsAreTooTight) {
  IseikonicOrder order = Anisometropia();
  order.left.back_vertex_power = Diopters(-9);
  const auto pair = DesignIseikonicPair(order);
  ASSERT_FALSE(pair);
  EXPECT_NE(pair.error().message.find("they reach"), std::string::npos);
}

TEST(DesignIseikonicPair, RejectsWhatCannotBeMeant) {
  IseikonicOrder order = Anisometropia();
  order.left.base_curve = Diopters(0);
  EXPECT_EQ(DesignIseikonicPair(order).error().message,
            "iseikonic:left.base_curve: got 0, want above 0, at most 14");
  order = Anisometropia();
  order.index = 1;
  EXPECT_FALSE(DesignIseikonicPair(order));
  order = Anisometropia();
  order.ratio = 3;
  EXPECT_FALSE(DesignIseikonicPair(order));
}

}  // namespace
}  // namespace lorgnette
