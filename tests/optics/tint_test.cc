// SPDX-License-Identifier: Apache-2.0
#include "optics/tint.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lorgnette {
namespace {

TEST(Tint, SolidTintFollowsThePathAndDipTintDoesNot) {
  const Tint solid = *GreyTint(TintKind::kSolid, 0.5, 2);
  EXPECT_NEAR(solid.Transmittance(550, 2), 0.5, 1e-15);
  EXPECT_NEAR(solid.Transmittance(550, 4), 0.25, 1e-15);
  const Tint dip = *GreyTint(TintKind::kDip, 0.5, 2);
  EXPECT_NEAR(dip.Transmittance(550, 2), 0.5, 1e-15);
  EXPECT_NEAR(dip.Transmittance(550, 8), 0.5, 1e-15);
}

TEST(Tint, AbsorbanceIsLinearBetweenEntriesAndConstantOutside) {
  const Tint tint{TintKind::kDip, {{400, 1}, {500, 0}, {700, 2}}};
  EXPECT_NEAR(tint.Transmittance(380, 1), 0.1, 1e-15);
  EXPECT_NEAR(tint.Transmittance(400, 1), 0.1, 1e-15);
  EXPECT_NEAR(tint.Transmittance(450, 1), std::pow(10, -0.5), 1e-15);
  EXPECT_NEAR(tint.Transmittance(600, 1), 0.1, 1e-15);
  EXPECT_NEAR(tint.Transmittance(780, 1), 0.01, 1e-15);
  EXPECT_EQ(Tint{}.Transmittance(500, 3), 1);
}

TEST(GreyTint, NamesWhatItCannotBe) {
  EXPECT_FALSE(GreyTint(TintKind::kDip, 0, 2));
  EXPECT_FALSE(GreyTint(TintKind::kDip, 1.2, 2));
  EXPECT_FALSE(GreyTint(TintKind::kSolid, 0.5, 0));
  EXPECT_EQ(GreyTint(TintKind::kDip, 1.2, 2).error().message,
            "tint: transmittance: got 1.2, want above 0, at most 1");
}

TEST(LuminousTransmittance, OfABareClearLensIsTheClosedForm) {
  for (const double n : {1.498, 1.6, 1.74}) {
    LensFilter filter;
    filter.index = n;
    EXPECT_NEAR(LuminousTransmittance(filter, 1, 2), 2 * n / (n * n + 1), 1e-14);
  }
}

TEST(LuminousTransmittance, OfACoatedClearLensExceedsNinetyEightPerCent) {
  LensFilter filter;
  filter.index = 1.6;
  filter.front_coat = filter.back_coat = CoatKind::kBroadband;
  EXPECT_GT(LuminousTransmittance(filter, 1, 2), 0.98);
  EXPECT_LT(LuminousTransmittance(filter, 1, 2), 1);
}

TEST(LuminousTransmittance, OfAGreyLensIsItsTintTimesItsSurfaces) {
  LensFilter filter;
  filter.index = 1.5;
  filter.tint = *GreyTint(TintKind::kDip, 0.2, 2);
  // Bounces inside pass the tint three times and more: 0.04^2 times 0.2^2 of the whole.
  EXPECT_NEAR(LuminousTransmittance(filter, 1, 2), 0.9216 * 0.2, 0.9216 * 0.2 * 7e-5);
}

TEST(LuminousTransmittance, FallsObliquely) {
  LensFilter filter;
  EXPECT_LT(LuminousTransmittance(filter, 0.3, 2), LuminousTransmittance(filter, 1, 2));
}

TEST(FilterCategory, HasTheLimitsOfTheStandard) {
  EXPECT_EQ(FilterCategory(0.92), 0);
  EXPECT_EQ(FilterCategory(0.80), 1);
  EXPECT_EQ(FilterCategory(0.43), 2);
  EXPECT_EQ(FilterCategory(0.18), 3);
  EXPECT_EQ(FilterCategory(0.08), 4);
  EXPECT_EQ(FilterCategory(0.0301), 4);
  EXPECT_FALSE(FilterCategory(0.03));
}

}  // namespace
}  // namespace lorgnette
