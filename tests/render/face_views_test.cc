// SPDX-License-Identifier: Apache-2.0
#include "render/face_views.h"

#include <gtest/gtest.h>

#include "render/directions.h"
#include "tests/render/render_test_scene.h"

namespace lorgnette {
namespace {

// A wall with a small square before it.
TEST(FaceViews, TellWhatRaysTellWhereCornersAgree) {
  const TriangleMesh face = test::Wall(60, 0, 6);
  const TriangleMesh square = test::Wall(24, 12, 2);
  const EmbreeScene scene = *EmbreeScene::Build(face, square, TriangleMesh{});
  const DirectionColumns directions(SphereDirections(512));
  FaceViews views(face, directions.size());
  for (std::size_t i = 0; i < face.positions.size(); ++i) views.Prepare(scene, directions, i);
  long hidden = 0, open = 0, unknown = 0, wrong = 0;
  for (const Eigen::Vector3i& t : face.triangles) {
    const Eigen::Vector3d middle =
        (face.positions[std::size_t(t[0])] + face.positions[std::size_t(t[1])] +
         face.positions[std::size_t(t[2])]) /
        3;
    const Eigen::Vector3f normal = face.normals[std::size_t(t[0])].cast<float>();
    for (std::size_t k = 0; k < directions.size(); ++k) {
      const FaceViews::View view = views.FromTriangle(t, k);
      if (directions[k].dot(normal) <= 0) {
        EXPECT_EQ(view, FaceViews::View::kUnknown);
        continue;
      }
      const bool blocked = scene.Occluded(
          RaySet::kHead, middle.cast<float>() + kFaceLift_mm * normal, directions[k], 0, kEndless);
      hidden += view == FaceViews::View::kHidden;
      open += view == FaceViews::View::kOpen;
      unknown += view == FaceViews::View::kUnknown;
      wrong += view != FaceViews::View::kUnknown && (view == FaceViews::View::kHidden) != blocked;
    }
  }
  // The wall's cells are 10 mm, the square 24 mm.
  EXPECT_GT(hidden, 300);
  EXPECT_GT(open, 20 * hidden);
  EXPECT_GT(unknown, 300);
  EXPECT_LT(unknown, open / 5);
  EXPECT_LT(double(wrong), 0.003 * double(open));
}

}  // namespace
}  // namespace lorgnette
