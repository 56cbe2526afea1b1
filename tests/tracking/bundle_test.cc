// SPDX-License-Identifier: Apache-2.0
#include "tracking/bundle.h"

#include <gtest/gtest.h>

#include "tests/tracking/synthetic_face.h"

namespace lorgnette {
namespace {

using test::AngleDeg;
using test::TestPose;

struct Scene {
  Camera camera = test::TestCamera();
  std::vector<Eigen::Isometry3d> poses;
  std::vector<Eigen::Vector3d> points;
  std::vector<BundleSighting> sightings;

  Scene() {
    for (const double yaw : {0.0, -20.0, -10.0, 10.0, 20.0}) {
      poses.push_back(TestPose(yaw, yaw / 3));
      poses.back().translation().z() += 4 * yaw;
    }
    const auto all = test::SyntheticCanonical().mesh.positions;
    points.assign(all.begin(), all.begin() + 120);
    for (std::size_t f = 0; f < poses.size(); ++f) {
      for (std::size_t p = 0; p < points.size(); ++p) {
        sightings.push_back({f, p, camera.Project(poses[f] * points[p]), 1});
      }
    }
  }
};

TEST(FitBundle, RecoversPosesDepthsAndFocalLength) {
  const Scene scene;
  Camera camera = scene.camera;
  camera.fx = camera.fy = 1400;
  std::vector<Eigen::Isometry3d> poses = scene.poses;
  for (std::size_t f = 1; f < poses.size(); ++f) {
    Eigen::Isometry3d& pose = poses[f];
    pose.linear() *=
        Eigen::AngleAxisd(0.05, Eigen::Vector3d(0.2, 1, 0.1).normalized()).toRotationMatrix();
  }
  std::vector<BundlePoint> points;
  const Eigen::Vector3d eye = scene.poses[0].inverse().translation();
  for (std::size_t p = 0; p < scene.points.size(); ++p) {
    const Eigen::Vector3d ray = (scene.points[p] - eye).normalized();
    const Eigen::Vector3d start = scene.points[p] + (p % 2 ? 3 : -3) * ray;
    points.push_back({start, ray, start});
  }
  BundleOptions options;
  options.sigma_px = 0.01;
  options.max_iterations = 100;
  const BundleReport report = FitBundle(scene.sightings, options, camera, poses, points);
  ASSERT_TRUE(report.usable);
  EXPECT_LT(report.rms_px, 0.05);
  // Priors (a quarter of the focal length, 12 mm of depth) against sightings good to 0.01 px.
  EXPECT_NEAR(camera.fx, scene.camera.fx, 15);
  EXPECT_EQ(camera.fx, camera.fy);
  for (std::size_t f = 1; f < poses.size(); ++f) {
    const Eigen::Matrix3d truth = scene.poses[0].linear().transpose() * scene.poses[f].linear();
    const Eigen::Matrix3d found = poses[0].linear().transpose() * poses[f].linear();
    EXPECT_LT(AngleDeg(found, truth), 0.1) << f;
  }
}

TEST(FitBundle, HoldsAKnownFocalLengthAndTheFixedFrame) {
  const Scene scene;
  Camera camera = scene.camera;
  std::vector<Eigen::Isometry3d> poses = scene.poses;
  poses[2] = poses[1];
  std::vector<BundlePoint> points;
  for (const Eigen::Vector3d& p : scene.points) points.push_back({p, Eigen::Vector3d::UnitZ(), p});
  BundleOptions options;
  options.focal_log_sigma = 0;
  ASSERT_TRUE(FitBundle(scene.sightings, options, camera, poses, points).usable);
  EXPECT_EQ(camera.fx, scene.camera.fx);
  // The rotation vector and back costs a few units in the last place.
  EXPECT_TRUE(poses[0].isApprox(scene.poses[0], 1e-12));
  EXPECT_LT(AngleDeg(poses[2].linear(), scene.poses[2].linear()), 0.01);
}

TEST(FitBundle, IsNotUsableWithoutSightings) {
  Camera camera = test::TestCamera();
  std::vector<Eigen::Isometry3d> poses{TestPose(0)};
  std::vector<BundlePoint> points;
  EXPECT_FALSE(FitBundle({}, {}, camera, poses, points).usable);
}

}  // namespace
}  // namespace lorgnette
