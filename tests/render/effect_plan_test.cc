// SPDX-License-Identifier: Apache-2.0
#include "render/effect_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "render/color.h"
#include "tests/render/render_test_scene.h"

namespace lorgnette {
namespace {

constexpr int kPlanWidth = 96, kPlanHeight = 64;
// A picture knows where an edge lies to the distance of its samples.
constexpr int kSamples = 4;
constexpr double kExplained_px = EffectBudget{}.shift_px + 1.0 / kSamples;

// Smooth waves, and edges every 11 pixels on request: something to shift.
ImageRgbF Skin(float level, bool edges) {
  ImageRgbF image(kPlanWidth, kPlanHeight);
  for (int y = 0; y < kPlanHeight; ++y) {
    for (int x = 0; x < kPlanWidth; ++x) {
      const float wave = 1 + 0.3f * std::sin(0.3f * float(x)) * std::sin(0.25f * float(y));
      const float step = edges && x / 11 % 2 == 0 ? 0.35f : 1.0f;
      image.at(x, y)[0] = level * wave * step;
      image.at(x, y)[1] = 0.8f * level * wave * step;
      image.at(x, y)[2] = 0.65f * level * wave * step;
    }
  }
  return image;
}

// A dim room with a lamp behind the camera, whose mirror image lies on the lenses.
Environment Room(float level, float lamp) {
  ImageRgbF map(64, 32);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const bool lit = x >= 26 && x < 38 && y >= 11 && y < 21;
      for (int c = 0; c < 3; ++c) map.at(x, y)[c] = lit ? lamp : level;
    }
  }
  return Environment(std::move(map));
}

struct Scene {
  test::LensRecipe lens;
  float skin = 0.4f, room = 0.3f, lamp = 1;
  bool edges = false;
  double distance_mm = 500, focal_px = 264, x_mm = 0;
  CompositorOptions options;
  float specular = 0;
};

struct Drawn {
  Compositor compositor;
  ImageRgbF input;
  test::View view;
  ImageRgbF With(const PictureEffects& effects) const {
    return compositor.Render(input, view.camera, view.camera_from_head, nullptr, &effects);
  }
  EffectPlan Plan(const char* wish) const {
    return compositor.Plan(input, view.camera, view.camera_from_head, *ParseEffects(wish));
  }
};

Drawn Draw(Scene scene) {
  Eyewear eyewear = test::WithRims(scene.lens);
  eyewear.frame.parts[0].material.specular.setConstant(scene.specular);
  scene.options.fade_temples = false;
  scene.options.shadow_directions = 256;
  scene.options.shadow_spacing_mm = 3;
  scene.options.samples_per_side = kSamples;
  auto compositor = Compositor::Create(eyewear, test::Wall(160, 0, 10), TriangleMesh{},
                                       Room(scene.room, scene.lamp), scene.options);
  EXPECT_TRUE(compositor) << compositor.error().message;
  return {
      *std::move(compositor), Skin(scene.skin, scene.edges),
      test::ViewFrom(scene.x_mm, 0, scene.distance_mm, kPlanWidth, kPlanHeight, scene.focal_px)};
}

double Code(float linear) { return 255 * SrgbFromLinear(std::clamp(double(linear), 0.0, 1.0)); }

// Largest difference in code values that no shift of the second picture by up to `shift_px`
// explains.
double Beyond(const ImageRgbF& a, const ImageRgbF& b, double shift_px) {
  double worst = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        double low = 1e9, high = -1e9;
        for (int k = 0; k < 9; ++k) {
          // Linear between neighbours: an upper bound of the change within the shift is the change
          // to the neighbour times the shift.
          const int u = std::clamp(x + k % 3 - 1, 0, b.width - 1);
          const int v = std::clamp(y + k / 3 - 1, 0, b.height - 1);
          const float mixed = b.at(x, y)[c] + float(shift_px) * (b.at(u, v)[c] - b.at(x, y)[c]);
          low = std::min(low, Code(mixed));
          high = std::max(high, Code(mixed));
        }
        const double code = Code(a.at(x, y)[c]);
        worst = std::max({worst, low - code, code - high});
      }
    }
  }
  return worst;
}

TEST(EffectPlan, ReadsWishes) {
  const auto choice = ParseEffects("none,+refraction,+tint");
  ASSERT_TRUE(choice);
  EXPECT_EQ(choice->wish[std::size_t(Effect::kRefraction)], EffectWish::kOn);
  EXPECT_EQ(choice->wish[std::size_t(Effect::kTint)], EffectWish::kOn);
  EXPECT_EQ(choice->wish[std::size_t(Effect::kShadow)], EffectWish::kOff);
  EXPECT_EQ(ParseEffects("auto,-shadow")->wish[0], EffectWish::kEstimate);
  EXPECT_EQ(ParseEffects("paper")->wish[std::size_t(Effect::kDispersion)], EffectWish::kOff);
  for (const char* wrong : {"", "some", "all,tint", "all,+tints", "all,,+tint", "+tint"}) {
    const auto refused = ParseEffects(wrong);
    ASSERT_FALSE(refused) << wrong;
    EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  }
}

TEST(EffectPlan, KeepsToWhatTheUserForces) {
  const Drawn drawn = Draw({});
  const EffectPlan none = drawn.Plan("none,+tint");
  for (int i = 0; i < kEffectCount; ++i) {
    EXPECT_EQ(none.effects.Any(Effect(i)), Effect(i) == Effect::kTint);
  }
  const EffectPlan all = drawn.Plan("all");
  for (int i = 0; i < kEffectCount; ++i) EXPECT_TRUE(all.effects.Any(Effect(i)));
}

// Scenes of every kind: powers, distance, light, skin, finishes.
std::vector<Scene> VariedScenes() {
  std::vector<Scene> scenes;
  const double powers[] = {-8, -4, -0.5, 0, 1, 4, 7};
  const char* coats[] = {"none", "ar", "none", "mirror-green", "single"};
  const char* tints[] = {"none", "none", "grey:85", "brown:50:solid", "none", "blue:99"};
  for (int i = 0; i < 22; ++i) {
    Scene s;
    s.lens.sphere = powers[i % 7];
    s.lens.cylinder = i % 4 == 1 ? -1.5 : 0;
    s.lens.abbe = i % 3 == 0 ? 30 : 58;
    s.skin = i % 5 == 3 ? 0.002f : 0.25f + 0.08f * float(i % 4);
    s.room = i % 3 == 1 ? 0.01f : 0.3f;
    s.lamp = i % 4 == 2 ? 20.0f : i % 4 == 3 ? 0.02f : 2.0f;
    s.edges = i % 2 == 0;
    s.distance_mm = i % 6 == 5 ? 4000 : 450 + 60 * (i % 5);
    s.x_mm = i % 8 == 7 ? 60 : 0;
    s.focal_px = i % 6 == 4 ? 720 : 264;
    EXPECT_TRUE(SetCoating(coats[i % 5], s.options.finish));
    EXPECT_TRUE(SetTint(tints[i % 6], s.options.finish));
    s.options.finish.edge = i % 2 == 0 ? EdgeFinish::kGround : EdgeFinish::kPolished;
    s.specular = i % 3 == 2 ? 0.2f : 0.0f;
    scenes.push_back(s);
  }
  return scenes;
}

TEST(EffectPlan, StaysWithinItsBudgetInVariedScenes) {
  int off = 0, on = 0;
  for (const Scene& scene : VariedScenes()) {
    const Drawn drawn = Draw(scene);
    const EffectPlan plan = drawn.Plan("auto");
    for (const EffectDecision& d : plan.decisions) (d.on ? on : off)++;
    const EffectBudget budget;
    const double beyond = Beyond(drawn.With(plan.effects),
                                 drawn.With(PictureEffects::Of(EffectSet::All())), budget.shift_px);
    EXPECT_LE(beyond, budget.code_values)
        << scene.lens.sphere << " D at " << scene.distance_mm << " mm\n"
        << EffectPlanJson(plan);
  }
  // The plan does plan.
  EXPECT_GT(off, 100);
  EXPECT_GT(on, 100);
}

// Scenes that need one effect each.
std::map<Effect, Scene> ScenesThatNeed() {
  std::map<Effect, Scene> scenes;
  Scene s;
  s.lens.sphere = -5;
  s.edges = true;
  scenes[Effect::kRefraction] = s;

  s = {};
  s.lens = {7, 0, 0, 1.6, 48, 36, 25};
  s.edges = true;
  s.focal_px = 2400;
  s.x_mm = -48;
  scenes[Effect::kDispersion] = s;

  s = {};
  s.lamp = 8;
  scenes[Effect::kFrontReflection] = s;
  s.options.finish.front_coat = CoatKind::kBroadband;
  scenes[Effect::kBackReflection] = s;

  s = {};
  s.lens.sphere = -8;
  s.skin = 0.05f;
  s.lamp = s.room = 3;
  scenes[Effect::kRings] = s;

  // A mirror in front of a bare back of high index keeps a third of what the back sends forward.
  s = {};
  s.lens = {-3, 0, 0, 1.74, 48, 36, 33};
  s.skin = 0.05f;
  s.room = s.lamp = 0.5f;
  s.options.finish.mirror = MirrorCoat::kSilver;
  scenes[Effect::kBounces] = s;

  s = {};
  EXPECT_TRUE(SetCoating("mirror-blue", s.options.finish));
  scenes[Effect::kCoating] = s;
  s = {};
  EXPECT_TRUE(SetTint("grey:60", s.options.finish));
  scenes[Effect::kTint] = s;
  scenes[Effect::kShadow] = {};
  s = {};
  s.lens.sphere = 5;
  s.options.shadow = ShadowMode::kGathered;
  scenes[Effect::kLensLight] = s;
  s = {};
  s.specular = 0.5f;
  s.lamp = 5;
  scenes[Effect::kGloss] = s;
  s = {};
  s.options.camera_look = {5, 1};
  scenes[Effect::kGrain] = s;
  return scenes;
}

TEST(EffectPlan, KeepsTheEffectThatASceneNeeds) {
  for (const auto& [effect, scene] : ScenesThatNeed()) {
    const Drawn drawn = Draw(scene);
    const EffectBudget budget;
    const EffectPlan plan = drawn.Plan("auto");
    EXPECT_TRUE(plan.effects.Any(effect)) << EffectName(effect) << EffectPlanJson(plan);
    EffectSet without = EffectSet::All();
    without.Set(effect, false);
    const double beyond = Beyond(drawn.With(PictureEffects::Of(without)),
                                 drawn.With(PictureEffects::Of(EffectSet::All())), kExplained_px);
    EXPECT_GT(beyond, budget.code_values) << EffectName(effect);
  }
}

TEST(EffectPlan, NeedsLessOfAFarFaceAndOfADarkRoom) {
  const auto count = [](const Scene& scene) {
    const EffectPlan plan = Draw(scene).Plan("auto");
    return std::count_if(plan.decisions.begin(), plan.decisions.end(),
                         [](const EffectDecision& d) { return d.on; });
  };
  Scene scene;
  const auto near = count(scene);
  scene.distance_mm = 20000;
  EXPECT_LT(count(scene), near);
  scene = {};
  scene.room = scene.lamp = 1e-5f;
  scene.skin = 1e-5f;
  EXPECT_LT(count(scene), near);
}

}  // namespace
}  // namespace lorgnette
