// SPDX-License-Identifier: Apache-2.0
#include "render/face_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "tests/render/render_test_scene.h"

namespace lorgnette {
namespace {

constexpr int kFaceWidth = 100, kFaceHeight = 100;

// The front of a sphere of 70 mm radius: a head without features.
TriangleMesh HalfSphere() {
  TriangleMesh mesh;
  constexpr int kRings = 24, kSpokes = 40;
  for (int j = 0; j <= kRings; ++j) {
    for (int i = 0; i < kSpokes; ++i) {
      const double a = 0.5 * kPi * j / kRings, b = 2 * kPi * i / kSpokes;
      const Eigen::Vector3d n(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
      mesh.normals.push_back(n);
      mesh.positions.push_back(70 * n);
    }
  }
  for (int j = 0; j < kRings; ++j) {
    for (int i = 0; i < kSpokes; ++i) {
      const int a = j * kSpokes + i, b = j * kSpokes + (i + 1) % kSpokes;
      mesh.triangles.emplace_back(a, a + kSpokes, b);
      mesh.triangles.emplace_back(b, a + kSpokes, b + kSpokes);
    }
  }
  return mesh;
}

// A soft light from one side over even grey: radiance 0.5 + 2 max(0, d . l)^3.
Eigen::Vector3d Light(const Eigen::Vector3d& d, const Eigen::Vector3d& from) {
  return Eigen::Vector3d(0.5, 0.5, 0.6) +
         Eigen::Vector3d(2, 1.6, 1.2) * std::pow(std::max(0.0, d.dot(from)), 3);
}

// Irradiance / pi by a sum over the sphere.
Eigen::Vector3d Shade(const Eigen::Vector3d& n, const Eigen::Vector3d& from) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  constexpr int kRows = 16;
  for (int y = 0; y < kRows; ++y) {
    const double lat = kPi * (0.5 - (y + 0.5) / kRows);
    for (int x = 0; x < 2 * kRows; ++x) {
      const double lon = kPi * (x + 0.5) / kRows;
      const Eigen::Vector3d d(std::sin(lon) * std::cos(lat), std::sin(lat),
                              std::cos(lon) * std::cos(lat));
      sum += std::max(0.0, d.dot(n)) * std::cos(lat) * Light(d, from) * kPi / kRows * kPi / kRows;
    }
  }
  return sum / kPi;
}

TEST(FaceLight, FindsTheSideThatTheLightComesFrom) {
  const TriangleMesh face = HalfSphere();
  const test::View view = test::ViewFrom(0, 0, 600, kFaceWidth, kFaceHeight, 350);
  const Eigen::Vector3d from = Eigen::Vector3d(0.8, 0.4, 0.5).normalized();
  // The picture: every pixel on the sphere by its normal (head and world axes agree here).
  ImageRgbF input(kFaceWidth, kFaceHeight);
  for (int y = 0; y < kFaceHeight; ++y) {
    for (int x = 0; x < kFaceWidth; ++x) {
      const Eigen::Vector3d c = view.camera.Direction(x + 0.5, y + 0.5).normalized();
      const Eigen::Vector3d d(c.x(), -c.y(), -c.z()), eye(0, 0, 600);
      const double b = -eye.dot(d), under = b * b - 600.0 * 600 + 70 * 70;
      Eigen::Vector3d colour(0.1, 0.1, 0.1);
      if (under >= 0) {
        colour = 0.4 * Shade((eye + (b - std::sqrt(under)) * d) / 70, from);
      }
      for (int k = 0; k < 3; ++k) input.at(x, y)[k] = float(colour[k]);
    }
  }
  // A brow: dark pixels that are no skin.
  for (int y = 35; y < 39; ++y) {
    for (int x = 35; x < 65; ++x) std::fill_n(input.at(x, y), 3, 0.02f);
  }
  const auto light = FitFaceLight(input, view.camera, view.camera_from_head, face,
                                  CompositorOptions{}.world_from_camera);
  ASSERT_TRUE(light);
  EXPECT_LT(light->residual, 0.15);  // the brow stays outside

  // The brightest direction of the fit, against the light's: the side behind the face is not seen,
  // which pulls the estimate toward the camera.
  const Environment map = EnvironmentOf(*light);
  Eigen::Vector3d best(0, 0, 1);
  float most = 0;
  for (int y = 0; y < map.map().height; ++y) {
    for (int x = 0; x < map.map().width; ++x) {
      if (map.map().at(x, y)[0] <= most) continue;
      most = map.map().at(x, y)[0];
      best = map.Direction(x + 0.5, y + 0.5).cast<double>();
    }
  }
  EXPECT_GT(best.dot(from), std::cos(RadiansFromDegrees(25)));
  // Red light is warmer on the lit side, as it was put there.
  const Eigen::Vector3f lit = light->At(from.cast<float>()), far = light->At(-from.cast<float>());
  EXPECT_GT(lit.x() / lit.z(), 1.2f);
  EXPECT_GT(lit.y(), 2 * far.y());

  // A map with a lamp keeps it, and takes the broad light on.
  ImageRgbF room(64, 32);
  std::fill(room.data.begin(), room.data.end(), 0.2f);
  for (int c = 0; c < 3; ++c) room.at(40, 10)[c] = 5;
  const Environment relit = Relit(Environment(std::move(room)), *light);
  EXPECT_GT(relit.map().at(40, 10)[1], 5 * relit.map().at(44, 10)[1]);
  EXPECT_GT(relit.Radiance(from.cast<float>()).y(), 2 * relit.Radiance(-from.cast<float>()).y());
}

TEST(FaceLight, NeedsAFaceInThePicture) {
  const test::View beside = test::ViewFrom(2000, 0, 600, kFaceWidth, kFaceHeight, 350);
  EXPECT_FALSE(FitFaceLight(test::ConstantImage(kFaceWidth, kFaceHeight, 0.3f), beside.camera,
                            beside.camera_from_head, HalfSphere(),
                            CompositorOptions{}.world_from_camera));
  const test::View view = test::ViewFrom(0, 0, 600, kFaceWidth, kFaceHeight, 350);
  EXPECT_FALSE(FitFaceLight(test::ConstantImage(kFaceWidth, kFaceHeight, 0), view.camera,
                            view.camera_from_head, HalfSphere(),
                            CompositorOptions{}.world_from_camera));
}

}  // namespace
}  // namespace lorgnette
