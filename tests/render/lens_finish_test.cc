// SPDX-License-Identifier: Apache-2.0
#include "render/lens_finish.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "render/compositor.h"
#include "tests/render/render_test_scene.h"

namespace lorgnette {
namespace {

constexpr double kIndex = 1.6;

LensFinish Coated(const char* name) {
  LensFinish finish;
  EXPECT_TRUE(SetCoating(name, finish));
  return finish;
}

TEST(LensFinish, LeavesBareGlassToFresnel) {
  const LensLook look = LookOf({}, kIndex, 20, -20);
  EXPECT_TRUE(look.plain());
  EXPECT_NEAR(NormalReflectance(look.front, kIndex).x(), std::pow(0.6 / 2.6, 2), 1e-6);
}

TEST(LensFinish, SharesTheLightOfClearCoatsOutWhole) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> cosine(0, 1);
  for (const char* name : {"single", "v", "ar", "mirror-blue", "mirror-gold"}) {
    const LensLook look = LookOf(Coated(name), kIndex, 20, -20);
    for (int i = 0; i < 200; ++i) {
      const float c = cosine(random);
      for (const auto& power :
           {look.front.FromAir(c), look.front.FromGlass(c), look.back.FromGlass(c)}) {
        // Both are sums of the same spectra, in single precision; colours outside 0..1 are clamped,
        // which only the strongest mirrors reach.
        EXPECT_LT((power.reflected + power.passed - Eigen::Vector3f::Ones()).cwiseAbs().maxCoeff(),
                  0.02f)
            << name << " at " << c;
      }
    }
  }
}

TEST(LensFinish, KnowsItsCoatsByTheirColours) {
  const auto mirrored = [](const char* name) {
    return NormalReflectance(LookOf(Coated(name), kIndex, 20, -20).front, kIndex);
  };
  // Bare glass of this index mirrors 5.3 per cent.
  EXPECT_LT(mirrored("ar").maxCoeff(), 0.03f);
  EXPECT_LT(mirrored("ar").y(), 0.005f);
  EXPECT_GT(mirrored("mirror-blue").z(), 2 * mirrored("mirror-blue").x());
  EXPECT_GT(mirrored("mirror-red").x(), 2 * mirrored("mirror-red").z());
  const Eigen::Vector3f silver = mirrored("mirror");
  EXPECT_GT(silver.minCoeff(), 0.2f);
  EXPECT_LT(silver.maxCoeff() - silver.minCoeff(), 0.1f);
}

TEST(LensFinish, HasASilverThatAbsorbs) {
  const auto power = LookOf(Coated("mirror"), kIndex, 20, -20).front.FromAir(1);
  EXPECT_LT((power.reflected + power.passed).maxCoeff(), 0.95f);
}

// A tint by its own spectral sum, at paths between the table's.
TEST(LensFinish, TintsLikeTheSpectrum) {
  for (const char* text : {"brown:40:solid", "green:25", "grey:80:solid"}) {
    LensFinish finish;
    ASSERT_TRUE(SetTint(text, finish));
    const TintOrder& order = *finish.tint;
    const TintLook look(order, 20, -20);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> path(0.2, 9);
    for (int i = 0; i < 50; ++i) {
      const double length = path(random);
      const Eigen::Vector3d exact = LinearRgbUnderD65(
          Sampled([&](double nm) { return order.tint.Transmittance(nm, length); }));
      const Eigen::Vector3f tabled = look.Between({0, 0, 0}, {0, 0, length});
      // The table is linear over 0.25 mm: off by h^2 / 8 of a curvature below 0.3 a mm^2.
      EXPECT_LT((tabled - exact.cwiseMax(0.0).cast<float>()).cwiseAbs().maxCoeff(), 0.003f)
          << text << ", " << length;
    }
    // As ordered: the luminous transmittance at the reference.
    EXPECT_NEAR(LuminousFraction(Sampled(
                    [&](double nm) { return order.tint.Transmittance(nm, order.reference_mm); })),
                order.luminous, 1e-9);
  }
}

TEST(LensFinish, FadesAGradientTowardTheBottom) {
  LensFinish finish;
  ASSERT_TRUE(SetTint("grey:20:gradient", finish));
  const TintLook look(*finish.tint, 18, -18);
  EXPECT_NEAR(look.Between({0, 18, 0}, {0, 18, 2}).y(), 0.2, 1e-3);
  EXPECT_NEAR(look.Between({0, 0, 0}, {0, 0, 2}).y(), std::sqrt(0.2), 1e-3);
  EXPECT_NEAR(look.Between({0, -18, 0}, {0, -18, 2}).y(), 1, 1e-6);
}

TEST(LensFinish, SaysWhatItCannotRead) {
  LensFinish finish;
  for (const char* text : {"grey", "grey:0", "grey:101", "grey:x", "pink:50", "grey:50:stripes"}) {
    const Status status = SetTint(text, finish);
    ASSERT_FALSE(status) << text;
    EXPECT_EQ(status.error().kind, ErrorKind::kUsage);
    EXPECT_NE(status.error().message.find(text), std::string::npos);
  }
  EXPECT_FALSE(SetCoating("gold", finish));
  EXPECT_FALSE(SetCoating("ar/mirror", finish));
  EXPECT_FALSE(SetCoating("ar/", finish));
  ASSERT_TRUE(SetCoating("mirror-gold/none", finish));
  EXPECT_EQ(finish.mirror, MirrorCoat::kGold);
  EXPECT_EQ(finish.back_coat, CoatKind::kNone);
  ASSERT_TRUE(SetCoating("single/ar", finish));
  EXPECT_EQ(finish.mirror, MirrorCoat::kNone);
  EXPECT_EQ(finish.front_coat, CoatKind::kSingle);
  EXPECT_EQ(finish.back_coat, CoatKind::kBroadband);
  EXPECT_FALSE(SetEdge("rough", finish));
  EXPECT_TRUE(SetTint("none", finish));
}

// The lens in the picture: its centre over an even wall, in a black room.
float CentreLevel(const char* coating, const char* tint, bool batch) {
  CompositorOptions options;
  options.shadow = ShadowMode::kNone;
  EXPECT_TRUE(SetCoating(coating, options.finish));
  EXPECT_TRUE(SetTint(tint, options.finish));
  // Both lenses in one tile go the exact way, one alone in batches.
  const test::View view =
      batch ? test::ViewFrom(-32, 0, 500, 33, 33, 400) : test::ViewFrom(0, 0, 3000, 33, 33, 400);
  const auto compositor =
      Compositor::Create(test::MakeEyewear({-3, 0, 0, kIndex}), test::Wall(600, 0), TriangleMesh{},
                         Environment::Constant({0, 0, 0}), options);
  EXPECT_TRUE(compositor) << compositor.error().message;
  const ImageRgbF output =
      compositor->Render(test::ConstantImage(33, 33, 0.5f), view.camera, view.camera_from_head);
  const Eigen::Vector3d lens(-32, 0, 14);
  const Eigen::Vector2d at = view.camera.Project(view.camera_from_head * lens);
  return output.at(int(at.x()), int(at.y()))[1] / 0.5f;
}

TEST(LensFinish, IsSeenInThePictureOnBothWaysOfTheRenderer) {
  const float r = float(std::pow(0.6 / 2.6, 2));
  for (const bool batch : {true, false}) {
    // Two surfaces, and what returns from the second is lost in a black room.
    EXPECT_NEAR(CentreLevel("none", "none", batch), (1 - r) * (1 - r), 0.005) << batch;
    EXPECT_GT(CentreLevel("ar", "none", batch), 0.985f) << batch;
    EXPECT_NEAR(CentreLevel("none", "grey:30", batch), 0.3f * (1 - r) * (1 - r), 0.005) << batch;
    EXPECT_LT(CentreLevel("mirror", "none", batch), 0.75f) << batch;
  }
}

}  // namespace
}  // namespace lorgnette
