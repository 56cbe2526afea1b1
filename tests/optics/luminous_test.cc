// SPDX-License-Identifier: Apache-2.0
#include "optics/luminous.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "optics/tint.h"

namespace lorgnette {
namespace {

Spectrum Even(double value) {
  Spectrum spectrum;
  spectrum.fill(value);
  return spectrum;
}

TEST(Luminous, TablesHaveThePublishedWhitePoint) {
  const Eigen::Vector2d white = ChromaticityUnderD65(Even(1));
  // CIE 15: x = 0.31272, y = 0.32903 from sums by 1 nm; sums by 10 nm differ in the fourth decimal.
  constexpr double kTenNanometres = 1.5e-4;
  EXPECT_NEAR(white.x(), 0.31272, kTenNanometres);
  EXPECT_NEAR(white.y(), 0.32903, kTenNanometres);
}

TEST(Luminous, EfficiencySumsToThePublishedIntegral) {
  const Spectrum& v = LuminousEfficiency();
  // The integral of V over wavelength is 106.857 nm.
  EXPECT_NEAR(10 * std::accumulate(v.begin(), v.end(), 0.0), 106.857, 0.01);
}

TEST(Luminous, EvenFilterKeepsItsFractionAndTheWhite) {
  EXPECT_NEAR(LuminousFraction(Even(0.37)), 0.37, 1e-15);
  const Eigen::Vector3d rgb = LinearRgbUnderD65(Even(0.37));
  EXPECT_LT((rgb - Eigen::Vector3d::Constant(0.37)).norm(), 1e-14);
}

TEST(Luminous, GreenCountsMoreThanBlue) {
  const auto band = [](double from, double to) {
    return Sampled([=](double nm) { return nm >= from && nm <= to ? 1.0 : 0.0; });
  };
  EXPECT_GT(LuminousFraction(band(530, 570)), 5 * LuminousFraction(band(430, 470)));
  EXPECT_GT(LinearRgbUnderD65(band(430, 470)).z(), 0.3);
  EXPECT_GT(LinearRgbUnderD65(band(620, 680)).x(), LinearRgbUnderD65(band(620, 680)).y());
}

TEST(Luminous, ChromaticityOfDarknessIsThatOfTheLight) {
  EXPECT_EQ(ChromaticityUnderD65(Even(0)), ChromaticityUnderD65(Even(1)));
}

TEST(CoatReflectance, OfASingleLayerIsPurpleAndTurnsBlueToRedderObliquely) {
  const Eigen::Vector3d straight = LinearRgbUnderD65(CoatReflectance(CoatKind::kSingle, 1.5, 1));
  // Least reflection in the green: what is left looks purple.
  EXPECT_GT(straight.x(), straight.y());
  EXPECT_GT(straight.z(), straight.y());
  // Obliquely the minimum moves to shorter waves, so red grows against blue.
  const Eigen::Vector3d oblique = LinearRgbUnderD65(CoatReflectance(CoatKind::kSingle, 1.5, 0.64));
  EXPECT_GT(oblique.x() / oblique.z(), straight.x() / straight.z());
}

}  // namespace
}  // namespace lorgnette
