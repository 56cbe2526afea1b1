// SPDX-License-Identifier: Apache-2.0
// The lenses' batches against RayFollower's exact way, ray by ray.
#include "render/lens_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "optics/trace.h"
#include "render/picture_view.h"
#include "tests/render/render_test_scene.h"

namespace lorgnette {
namespace {

constexpr int kColumns = 320, kRows = 160;

// Light that differs by direction, between 0.2 and 1.
Environment Gradient() {
  ImageRgbF map(128, 64);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      map.at(x, y)[0] = 0.6f + 0.4f * std::sin(float(2 * kPi) * float(x) / 128);
      map.at(x, y)[1] = 0.2f + 0.8f * float(y) / 64;
      map.at(x, y)[2] = 0.6f + 0.4f * std::cos(float(2 * kPi) * float(x) / 128);
    }
  }
  return Environment(std::move(map));
}

// A strong lens seen from the side: some rays are reflected in whole at its back, others end at the
// ground wall.
TEST(LensPass, AgreesWithTheExactWay) {
  const Eyewear eyewear = test::MakeEyewear({-12, 0, 0, 1.5, 50, 40});
  const TriangleMesh face = test::Wall(90, 0);
  const Environment environment = Gradient();
  CompositorOptions options;
  options.shadow = ShadowMode::kNone;
  options.samples_per_side = 1;
  options.effects = EffectSet::Paper();
  options.effects.Set(Effect::kBackReflection, true);
  options.effects.Set(Effect::kRings, true);
  test::View view = test::ViewFrom(0, 0, 300, kColumns, kRows, 420);
  view.camera_from_head.rotate(Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitY()));
  ImageRgbF picture(kColumns, kRows);
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      picture.at(x, y)[0] = 0.5f + 0.3f * std::sin(0.02f * float(x));
      picture.at(x, y)[1] = picture.at(x, y)[2] = 0.4f;
    }
  }
  const ImageRgbF output = Compositor::Create(eyewear, face, TriangleMesh{}, environment, options)
                               ->Render(picture, view.camera, view.camera_from_head);

  auto head = HeadScene::Build(eyewear, face, TriangleMesh{}, environment, options);
  ASSERT_TRUE(head) << head.error().message;
  const InputPicture input(picture);
  const PictureView seen(input, view.camera, view.camera_from_head, head->scene,
                         head->face_vertices, head->face_normals, head->face_triangles,
                         view.camera_from_head.translation().z() + options.background_distance_mm);
  const RayFollower follower(*head, seen, view.camera, view.camera_from_head,
                             PictureEffects::Of(options.effects));
  const Eigen::Isometry3d head_from_camera = view.camera_from_head.inverse();
  struct Tally {
    long all = 0, off = 0;
  } total, to_wall, through;
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      const Ray ray{
          head_from_camera.translation(),
          (head_from_camera.linear() * view.camera.Direction(x + 0.5, y + 0.5)).normalized()};
      const auto glass = follower.FirstGlass(ray);
      const SceneHit direct = head->scene.Intersect(RaySet::kHead, ray.origin.cast<float>(),
                                                    ray.direction.cast<float>(), 0, kEndless);
      if (!glass || (direct.hit() && double(direct.distance) < glass->hit.distance) ||
          glass->hit.face != SolidFace::kFront) {
        continue;
      }
      const LensSolid& solid = head->lenses[glass->lens];
      const double index = solid.lens().medium.index_d;
      const auto in = Refract(glass->ray.direction, glass->hit.normal, 1 / index);
      ASSERT_TRUE(in);
      const auto leave = solid.Leave({glass->hit.point, in->normalized()});
      ASSERT_TRUE(leave);
      const bool at_wall = leave->face == SolidFace::kWall;
      const bool mirrored =
          leave->face == SolidFace::kBack && !Refract(in->normalized(), leave->normal, index);
      Tally& tally = at_wall ? to_wall : mirrored ? total : through;
      ++tally.all;
      PixelState pixel;
      const Eigen::Vector3f exact =
          follower.EnterGlass(glass->lens, glass->ray, glass->hit, 1, 0, pixel);
      const Eigen::Map<const Eigen::Vector3f> drawn(output.at(x, y));
      // The batch gives what a surface sends back a second time, some 5 per cent of light of 1 at
      // most, to the ray that it came from; toward grazing that is more.
      tally.off += (drawn - exact).cwiseAbs().maxCoeff() > 0.06f;
    }
  }
  for (const Tally& tally : {total, to_wall, through}) {
    EXPECT_GT(tally.all, 100);
    EXPECT_LE(double(tally.off), 0.02 * double(tally.all));
  }
}

}  // namespace
}  // namespace lorgnette
