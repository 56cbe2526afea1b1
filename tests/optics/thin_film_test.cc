// SPDX-License-Identifier: Apache-2.0
#include "optics/thin_film.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lorgnette {
namespace {

constexpr CoatKind kAllCoats[] = {CoatKind::kNone, CoatKind::kSingle, CoatKind::kVCoat,
                                  CoatKind::kBroadband};

TEST(FilmPower, OfAnEmptyStackIsTheBareSurface) {
  for (const double c : {1.0, 0.7, 0.2, 0.01}) {
    const PolarizedPower film = FilmPower({1, {}, 1.6}, 550, c), bare = FresnelPower(c, 1, 1.6);
    EXPECT_NEAR(film.rs, bare.rs, 1e-14);
    EXPECT_NEAR(film.rp, bare.rp, 1e-14);
    EXPECT_NEAR(film.ts, bare.ts, 1e-14);
    EXPECT_NEAR(film.tp, bare.tp, 1e-14);
  }
}

TEST(FilmPower, OfASingleQuarterWaveMatchesThePublishedValues) {
  struct Row {
    double ns, percent;
  };
  for (const Row& row : {Row{1.5, 1.411}, Row{1.523, 1.238}, Row{1.6, 0.755}, Row{1.67, 0.430}}) {
    const double r = FilmPower(CoatOn(CoatKind::kSingle, row.ns), 550, 1).reflectance();
    EXPECT_NEAR(100 * r, row.percent, 0.0005 + 1e-9);  // printed to three decimals
    const double closed = (row.ns - 1.38 * 1.38) / (row.ns + 1.38 * 1.38);
    EXPECT_NEAR(r, closed * closed, 1e-16);
  }
}

TEST(FilmPower, OfTwoQuarterWavesMatchesTheClosedForm) {
  const double n1 = 1.38, n2 = 1.7, ns = 1.6;
  const FilmStack stack{
      1, {{n1, QuarterWave_nm(n1, 550), 0}, {n2, QuarterWave_nm(n2, 550), 0}}, ns};
  const double closed = (n1 * n1 * ns - n2 * n2) / (n1 * n1 * ns + n2 * n2);
  EXPECT_NEAR(FilmPower(stack, 550, 1).reflectance(), closed * closed, 1e-16);
}

TEST(FilmPower, OfTheVCoatIsZeroAtItsWavelength) {
  const FilmStack stack = CoatOn(CoatKind::kVCoat, 1.6);
  EXPECT_NEAR(stack.layers[0].thickness_nm, 116.186, 0.0005);
  EXPECT_NEAR(stack.layers[1].thickness_nm, 25.672, 0.0005);
  for (const double ns : {1.498, 1.523, 1.586, 1.6, 1.67, 1.74}) {
    EXPECT_LT(FilmPower(CoatOn(CoatKind::kVCoat, ns), 550, 1).reflectance(), 1e-25);
  }
}

TEST(FilmPower, ConservesEnergyAtEveryAngleColourAndPolarization) {
  double worst = 0;
  for (const CoatKind kind : kAllCoats) {
    const FilmStack outside = CoatOn(kind, 1.6);
    for (const FilmStack& stack : {outside, Reversed(outside)}) {
      for (double nm = 380; nm <= 780; nm += 40) {
        for (int deg = 0; deg < 90; deg += 3) {
          const auto power = FilmPower(stack, nm, std::cos(deg * 3.14159265358979 / 180));
          worst = std::max(
              {worst, std::abs(power.rs + power.ts - 1), std::abs(power.rp + power.tp - 1)});
          ASSERT_GE(power.ts, 0);
          ASSERT_GE(power.tp, 0);
        }
      }
    }
  }
  std::printf("energy balance of stacks: worst %.2g\n", worst);
  EXPECT_LT(worst, 1e-12);
}

TEST(FilmPower, LosesToAbsorptionOnly) {
  FilmStack stack = CoatOn(CoatKind::kBroadband, 1.6);
  stack.layers[1].extinction = 0.05;
  const auto power = FilmPower(stack, 500, 0.8);
  EXPECT_LT(power.rs + power.ts, 1);
  EXPECT_LT(power.rp + power.tp, 1);
  EXPECT_GT(power.ts, 0.5);
}

TEST(FilmPower, TransmitsTheSameFromEitherSide) {
  const FilmStack stack = CoatOn(CoatKind::kBroadband, 1.6);
  const double c1 = 0.6, c2 = std::sqrt(1 - (1 - c1 * c1) / (1.6 * 1.6));
  const auto in = FilmPower(stack, 480, c1), out = FilmPower(Reversed(stack), 480, c2);
  EXPECT_NEAR(in.ts, out.ts, 1e-14);
  EXPECT_NEAR(in.tp, out.tp, 1e-14);
  EXPECT_NEAR(in.rs, out.rs, 1e-14);
}

TEST(FilmPower, GivesNoNanAtGrazingIncidence) {
  for (const CoatKind kind : kAllCoats) {
    for (const double c : {0.0, 1e-300, 1e-12}) {
      const auto power = FilmPower(CoatOn(kind, 1.6), 550, c);
      EXPECT_NEAR(power.reflectance(), 1, 1e-9);
      EXPECT_NEAR(power.transmittance(), 0, 1e-9);
    }
  }
}

TEST(CoatOn, BroadbandStaysBelowOnePerCentOverTheVisible) {
  const FilmStack stack = CoatOn(CoatKind::kBroadband, 1.6);
  EXPECT_LT(FilmPower(stack, 550, 1).reflectance(), 1e-4);
  for (double nm = 450; nm <= 660; nm += 10) {
    EXPECT_LT(FilmPower(stack, nm, 1).reflectance(), 0.01) << nm;
  }
}

}  // namespace
}  // namespace lorgnette
