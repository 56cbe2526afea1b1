// SPDX-License-Identifier: Apache-2.0
#include "render/compositor.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "geometry/sweep.h"
#include "render/color.h"
#include "tests/render/render_test_scene.h"

namespace lorgnette {
namespace {

using test::LensRecipe;
using test::WithRims;

ImageRgbF Pattern(int width, int height) {
  ImageRgbF image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y)[0] = 0.4f + 0.2f * std::sin(0.13f * float(x));
      image.at(x, y)[1] = 0.4f + 0.2f * std::sin(0.09f * float(y));
      image.at(x, y)[2] = 0.4f + 0.2f * std::sin(0.07f * float(x + y));
    }
  }
  return image;
}

constexpr int kViewWidth = 240, kViewHeight = 120;
test::View Front() { return test::ViewFrom(0, 0, 500, kViewWidth, kViewHeight, 800); }

Compositor Make(const Eyewear& eyewear, const TriangleMesh& face, const Environment& environment,
                const CompositorOptions& options) {
  auto compositor = Compositor::Create(eyewear, face, TriangleMesh{}, environment, options);
  EXPECT_TRUE(compositor) << compositor.error().message;
  return *std::move(compositor);
}

TEST(Compositor, ChangesNoPixelBesideTheEyewear) {
  CompositorOptions options;
  options.shadow = ShadowMode::kNone;
  const ImageRgbF input = Pattern(kViewWidth, kViewHeight);
  const test::View view = Front();
  const Compositor compositor =
      Make(test::MakeEyewear({}), test::Wall(400, 0), Environment::Constant({1, 1, 1}), options);
  const ImageRgbF output = compositor.Render(input, view.camera, view.camera_from_head);
  const ImageRgbaF hits = compositor.HitMap(view.camera, view.camera_from_head);
  int same = 0, changed = 0;
  for (int y = 1; y + 1 < kViewHeight; ++y) {
    for (int x = 1; x + 1 < kViewWidth; ++x) {
      bool beside = true;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) beside = beside && hits.at(x + dx, y + dy)[3] == 5;
      }
      const bool equal = std::equal(input.at(x, y), input.at(x, y) + 3, output.at(x, y));
      if (beside) {
        EXPECT_TRUE(equal) << x << ", " << y;
      }
      same += beside;
      changed += !equal;
    }
  }
  EXPECT_GT(same, kViewWidth * kViewHeight / 4);
  EXPECT_GT(changed, 2000);
}

// In a white furnace nothing can be seen: all light that a lens takes from one direction it gives
// from another.
TEST(Compositor, ShowsNoLensInAWhiteFurnace) {
  for (const LensRecipe& recipe : {LensRecipe{-6, 0, 0, 1.6}, LensRecipe{5, -1, 20, 1.5}}) {
    CompositorOptions options;
    options.shadow = ShadowMode::kNone;
    options.finish.edge = EdgeFinish::kPolished;
    options.max_internal_bounces = 16;
    const test::View view = Front();
    const ImageRgbF input = test::ConstantImage(kViewWidth, kViewHeight, 1);
    const ImageRgbF output = Make(test::MakeEyewear(recipe), test::Wall(600, 0),
                                  Environment::Constant({1, 1, 1}), options)
                                 .Render(input, view.camera, view.camera_from_head);
    double sum = 0;
    float worst = 0;
    for (const float v : output.data) {
      sum += double(v);
      worst = std::max(worst, std::abs(v - 1));
    }
    // Branches below options.least_weight are given to the other branch, which keeps the sum; a
    // chain of total reflections in the edge may be cut at the last bounce, in single samples.
    EXPECT_NEAR(sum / double(output.data.size()), 1, 1e-3) << recipe.sphere;
    EXPECT_LT(worst, 0.5f) << recipe.sphere;
  }
}

// Metal that mirrors metal shows metal: a rim's inner wall, seen from the side, mirrors the wall
// across, and is not black where it does.
TEST(Compositor, ShowsNoBlackOnMetalInAWhiteFurnace) {
  constexpr float kMetal = 0.8f;
  Eyewear eyewear = WithRims({});
  for (FramePart& part : eyewear.frame.parts) {
    part.material.diffuse.setZero();
    part.material.specular.setConstant(kMetal);
  }
  CompositorOptions options;
  options.shadow = ShadowMode::kNone;
  const Compositor compositor =
      Make(eyewear, test::Wall(600, 0), Environment::Constant({1, 1, 1}), options);
  const test::View view = test::ViewFrom(60, 0, 150, kViewWidth, kViewHeight, 150);
  const ImageRgbF output = compositor.Render(test::ConstantImage(kViewWidth, kViewHeight, 1),
                                             view.camera, view.camera_from_head);
  const ImageRgbaF hits = compositor.HitMap(view.camera, view.camera_from_head);
  long seen = 0;
  float least = 1;
  for (int y = 0; y < hits.height; ++y) {
    for (int x = 0; x < hits.width; ++x) {
      if (int(std::lround(hits.at(x, y)[3])) != int(HitCode::kFrame)) continue;
      ++seen;
      least = std::min(least, output.at(x, y)[1]);
    }
  }
  EXPECT_GT(seen, 1000);
  // Twice mirrored, and at least half of the sky is open to the second mirror.
  EXPECT_GT(least, 0.5f * kMetal * kMetal);
}

// The light of a window, mirrored by a bar thinner than a pixel, is a line and no row of dots.
TEST(Compositor, MirrorsAWindowInAThinBarWithoutDots) {
  constexpr double kRadius_mm = 0.4, kSlope = 0.12;
  Eyewear eyewear = test::MakeEyewear({});
  BarShape shape;
  shape.section = Superellipse(24, 2);
  FramePart bar;
  bar.kind = FramePartKind::kFront;
  bar.mesh = SweepBar(
      [&](double v, double q, double w) {
        const double x = 200 * (v - 0.5);
        return Eigen::Vector3d(x, 30 + kSlope * x + kRadius_mm * q, 20 + kRadius_mm * w);
      },
      shape);
  bar.material.diffuse.setZero();
  bar.material.specular.setConstant(0.5f);
  bar.material.shininess = 90;
  eyewear.frame.parts = {bar};
  ImageRgbF sky(128, 64);
  for (int y = 10; y < 16; ++y) {
    for (int x = 56; x < 64; ++x) std::fill_n(sky.at(x, y), 3, 60.0f);
  }
  const test::View view = Front();
  const ImageRgbF input = test::ConstantImage(kViewWidth, kViewHeight, 0);
  // Mean and deviation of the columns' light.
  const auto along = [&](int samples) {
    CompositorOptions options;
    options.shadow = ShadowMode::kNone;
    options.samples_per_side = samples;
    const ImageRgbF output = Make(eyewear, test::Wall(600, 0), Environment(sky), options)
                                 .Render(input, view.camera, view.camera_from_head);
    double sum = 0, squares = 0;
    for (int x = 60; x < 180; ++x) {
      double column = 0;
      for (int y = 0; y < 60; ++y) column += double(output.at(x, y)[1]);
      sum += column;
      squares += column * column;
    }
    const double mean = sum / 120;
    return std::pair(mean, std::sqrt(std::max(0.0, squares / 120 - mean * mean)));
  };
  const auto [truth, unevenness] = along(12);
  EXPECT_LT(unevenness / truth, 0.15);
  // Without widened lobes 1.5 and 0.8.
  for (const auto& [samples, bound] : {std::pair(2, 0.8), std::pair(4, 0.2)}) {
    const auto [mean, deviation] = along(samples);
    EXPECT_NEAR(mean / truth, 1, 0.05) << samples;
    EXPECT_LT(deviation / mean, bound) << samples;
  }
}

TEST(Compositor, GivesTheSamePixelsOnAnyNumberOfThreads) {
  const ImageRgbF input = Pattern(kViewWidth, kViewHeight);
  const test::View view = Front();
  ImageRgbF results[2];
  for (const bool adaptive : {false, true}) {
    CompositorOptions options;
    options.adaptive = adaptive;
    for (const int threads : {1, 4}) {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                        std::size_t(threads));
      results[threads > 1] = Make(WithRims({}), test::Wall(400, 0, 20),
                                  Environment::Constant({1, 0.8f, 0.6f}), options)
                                 .Render(input, view.camera, view.camera_from_head);
    }
    EXPECT_EQ(results[0].data, results[1].data);
  }
}

// Strong lenses, so that rays read the picture far from where they entered it.
TEST(Compositor, DrawsTheSameFromAndToDisplayEncodedPixels) {
  const ImageRgb8 input = DisplayFromLinear(Pattern(kViewWidth, kViewHeight));
  const test::View view = test::ViewFrom(0, 0, 500, kViewWidth, kViewHeight, 500);
  for (const bool adaptive : {false, true}) {
    CompositorOptions options;
    options.adaptive = adaptive;
    const Compositor compositor = Make(WithRims({-14, 0, 0, 1.6}), test::Wall(150, 0, 20),
                                       Environment::Constant({1, 0.8f, 0.6f}), options);
    RenderCounts counts, display_counts;
    const ImageRgbF linear =
        compositor.Render(LinearFromDisplay(input), view.camera, view.camera_from_head, &counts);
    const ImageRgb8 display =
        compositor.Render(input, view.camera, view.camera_from_head, &display_counts);
    EXPECT_EQ(display.data, DisplayFromLinear(linear).data) << adaptive;
    EXPECT_NE(display.data, input.data);
    EXPECT_EQ(counts.lens_pixels, display_counts.lens_pixels);
    EXPECT_EQ(counts.filled_samples, display_counts.filled_samples);
  }
}

double Psnr(const ImageRgbF& a, const ImageRgbF& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) sum += std::pow(double(a.data[i] - b.data[i]), 2);
  return -10 * std::log10(sum / double(a.data.size()));
}

TEST(Compositor, LooksTheSameWithAdaptiveSamples) {
  const ImageRgbF input = Pattern(kViewWidth, kViewHeight);
  const test::View view = Front();
  CompositorOptions options;
  RenderCounts full_counts, adaptive_counts;
  const Environment light = Environment::Constant({1, 1, 1});
  const ImageRgbF full = Make(WithRims({}), test::Wall(400, 0, 20), light, options)
                             .Render(input, view.camera, view.camera_from_head, &full_counts);
  options.adaptive = true;
  const ImageRgbF adaptive =
      Make(WithRims({}), test::Wall(400, 0, 20), light, options)
          .Render(input, view.camera, view.camera_from_head, &adaptive_counts);
  EXPECT_GT(Psnr(full, adaptive), 50);  // the bound
  EXPECT_GT(full_counts.frame_pixels, 500);
  EXPECT_GT(adaptive_counts.frame_pixels, 500);
}

TEST(Compositor, DarkensTheSkinBelowTheFrameInBothModes) {
  const ImageRgbF input = test::ConstantImage(kViewWidth, kViewHeight, 0.5f);
  const test::View view = Front();
  CompositorOptions options;
  options.shadow_rays = 1000;
  const Environment light = Environment::Constant({1, 1, 1});
  ImageRgbF by_mode[2];
  for (const ShadowMode mode : {ShadowMode::kBaked, ShadowMode::kPaper}) {
    options.shadow = mode;
    by_mode[mode == ShadowMode::kPaper] = Make(WithRims({}), test::Wall(400, 0, 20), light, options)
                                              .Render(input, view.camera, view.camera_from_head);
  }
  // Just below the right rim, where skin is seen directly.
  const int x = int(view.camera.cx - 800 * 32 / 500.0), y = int(view.camera.cy + 800 * 27 / 500.0);
  EXPECT_LT(by_mode[0].at(x, y)[1], 0.49f);
  EXPECT_GT(by_mode[0].at(x, y)[1], 0.2f);
  // 1000 rays: a share of 0.1 is known to 0.01; the baked lattice to 0.02.
  EXPECT_NEAR(by_mode[0].at(x, y)[1], by_mode[1].at(x, y)[1], 0.5 * 0.03);
}

TEST(Compositor, LeavesOutWhatIsSwitchedOff) {
  const ImageRgbF input = Pattern(kViewWidth, kViewHeight);
  const test::View view = Front();
  CompositorOptions options;
  options.effects = EffectSet::None();
  options.shadow = ShadowMode::kNone;
  options.finish.edge = EdgeFinish::kPolished;
  const ImageRgbF output =
      Make(test::MakeEyewear({}), test::Wall(400, 0), Environment::Constant({5, 5, 5}), options)
          .Render(input, view.camera, view.camera_from_head);
  // Straight through and without loss: the input, but for the resampling of a smooth pattern.
  EXPECT_GT(Psnr(input, output), 60);
}

TEST(Compositor, WorksAtTheEdgesOfWhatACameraCanDo) {
  const Compositor compositor =
      Make(WithRims({}), test::Wall(400, 0), Environment::Constant({1, 1, 1}), CompositorOptions{});
  // One pixel.
  const test::View one = test::ViewFrom(-32, 0, 500, 1, 1, 2);
  EXPECT_EQ(compositor.Render(test::ConstantImage(1, 1, 0.5f), one.camera, one.camera_from_head)
                .data.size(),
            3u);
  // The lens behind the camera: nothing to insert.
  const test::View behind = test::ViewFrom(0, 0, 10, 32, 16, 30);
  const ImageRgbF input = Pattern(32, 16);
  for (const float v : compositor.Render(input, behind.camera, behind.camera_from_head).data) {
    EXPECT_TRUE(std::isfinite(v));
  }
  // The face beside the picture.
  const test::View beside = test::ViewFrom(2000, 0, 500, 32, 16, 100);
  EXPECT_EQ(compositor.Render(input, beside.camera, beside.camera_from_head).data, input.data);
}

TEST(Compositor, WorksWithAFaceThatFillsThePictureOrLeavesIt) {
  const Compositor compositor =
      Make(WithRims({}), test::Wall(400, 0), Environment::Constant({1, 1, 1}), CompositorOptions{});
  const ImageRgb8 input = DisplayFromLinear(Pattern(96, 64));
  // One eye fills the picture; the left half of the face is outside it; the camera is so near that
  // parts of the temples and of the face lie behind it.
  for (const test::View& view :
       {test::ViewFrom(-32, 0, 200, 96, 64, 600), test::ViewFrom(-60, 0, 400, 96, 64, 300),
        test::ViewFrom(0, 0, 21, 96, 64, 40)}) {
    RenderCounts counts;
    const ImageRgb8 output = compositor.Render(input, view.camera, view.camera_from_head, &counts);
    EXPECT_EQ(output.width, 96);
    EXPECT_GT(counts.lens_pixels + counts.shadowed_pixels, 100);
    EXPECT_NE(output.data, input.data);
  }
}

TEST(Compositor, LeavesAnEightKPictureAloneBesideTheFace) {
  ImageRgb8 input(7680, 4320);
  std::fill(input.data.begin(), input.data.end(), std::uint8_t{90});
  // A face 90 pixels wide in the upper left corner.
  test::View view = test::ViewFrom(0, 0, 500, 7680, 4320, 300);
  view.camera.cx = 200;
  view.camera.cy = 150;
  const ImageRgb8 output =
      Make(WithRims({}), test::Wall(150, 0), Environment::Constant({1, 1, 1}), CompositorOptions{})
          .Render(input, view.camera, view.camera_from_head);
  EXPECT_FALSE(std::equal(output.at(0, 150), output.at(400, 150), input.at(0, 150)));
  EXPECT_TRUE(std::equal(output.at(0, 400), output.at(0, 4319), input.at(0, 400)));
}

TEST(Compositor, PassesOverTrianglesWithoutArea) {
  const ImageRgb8 input = DisplayFromLinear(Pattern(kViewWidth, kViewHeight));
  const test::View view = Front();
  TriangleMesh wall = test::Wall(400, 0), spoilt = wall;
  const int last = int(spoilt.positions.size()) - 1;
  spoilt.triangles.emplace_back(last, last, last);          // a point
  spoilt.triangles.emplace_back(last, last - 1, last);      // a line
  spoilt.triangles.emplace_back(last, last - 1, last - 2);  // three points in a row
  wall.normals.clear();
  spoilt.normals.clear();
  const Environment light = Environment::Constant({1, 1, 1});
  const ImageRgb8 whole = Make(WithRims({}), wall, light, CompositorOptions{})
                              .Render(input, view.camera, view.camera_from_head);
  const ImageRgb8 picture = Make(WithRims({}), spoilt, light, CompositorOptions{})
                                .Render(input, view.camera, view.camera_from_head);
  // Rays through an edge may be told that they met its other side.
  for (std::size_t i = 0; i < whole.data.size(); ++i) {
    ASSERT_NEAR(int(picture.data[i]), int(whole.data[i]), 1);
  }
}

TEST(Compositor, RefusesAFaceWithoutTriangles) {
  const auto compositor = Compositor::Create(test::MakeEyewear({}), TriangleMesh{}, TriangleMesh{},
                                             Environment::Constant({1, 1, 1}), {});
  ASSERT_FALSE(compositor);
}

TEST(Compositor, MatchesTheExposureOfAGreyFace) {
  const test::View view = Front();
  Compositor compositor = Make(test::MakeEyewear({}), test::Wall(200, 0),
                               Environment::Constant({2, 2, 2}), CompositorOptions{});
  // A wall of albedo 0.4 under light of 2 has radiance 0.8.
  const double scale = compositor.MatchExposure(test::ConstantImage(kViewWidth, kViewHeight, 0.2f),
                                                view.camera, view.camera_from_head);
  EXPECT_NEAR(scale, 0.25, 0.005);
}

}  // namespace
}  // namespace lorgnette
