// SPDX-License-Identifier: Apache-2.0
#include "tracking/iris.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/tracking/synthetic_face.h"

namespace lorgnette {
namespace {

using test::TestCamera;
using test::TestPose;

constexpr double kPd = 63.5;
const Eigen::Vector3d kApex(-kPd / 2, 0, 0);

// A crop of an eye: white, with a dark disc of `radius_mm` displaced by (dx, dy) mm, and lids that
// cover its top and bottom.
FaceCrop EyeCrop(const Eigen::Isometry3d& pose, double dx, double dy, double radius_mm) {
  FaceCrop crop;
  crop.region = {TestCamera().Project(pose * Eigen::Vector3d::Zero()), 500, 0.05};
  crop.grey = Image<std::uint8_t, 1>(256, 256);
  const Eigen::Isometry3d head_from_camera = pose.inverse();
  const Eigen::Vector3d eye = head_from_camera.translation();
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      // Four samples a pixel and axis, so that the rim lies between pixels.
      double sum = 0;
      for (int k = 0; k < 16; ++k) {
        const Eigen::Vector2d uv((x + (k % 4 + 0.5) / 4) / 256, (y + (k / 4 + 0.5) / 4) / 256);
        const Eigen::Vector2d px = crop.region.ToImage(uv);
        const Eigen::Vector3d ray =
            head_from_camera.linear() * TestCamera().Direction(px.x(), px.y());
        const Eigen::Vector3d p = eye + (-2.3 - eye.z()) / ray.z() * ray;
        const double from_x = p.x() - kApex.x() - dx, from_y = p.y() - dy;
        const bool lid = p.y() > 4.2 || p.y() < -5;
        sum += lid ? 150 : std::hypot(from_x, from_y) < radius_mm ? 60 : 210;
      }
      *crop.grey.at(x, y) = std::uint8_t(std::lround(sum / 16));
    }
  }
  return crop;
}

TEST(FindIris, FindsItsCentreAndRadius) {
  for (const double yaw : {0.0, 18.0}) {
    const Eigen::Isometry3d pose = TestPose(yaw);
    const auto iris = FindIris(EyeCrop(pose, 1.4, -0.6, 5.7), TestCamera(), pose, kApex, kPd);
    ASSERT_TRUE(iris);
    const Eigen::Vector2d truth =
        TestCamera().Project(pose * (kApex + Eigen::Vector3d(1.4, -0.6, -2.3)));
    // A crop pixel is two pixels of the frame: an eighth of it across, less well in height, where
    // only the free parts of the rim tell.
    EXPECT_NEAR(iris->pixel.x(), truth.x(), 0.25) << yaw;
    EXPECT_NEAR(iris->pixel.y(), truth.y(), 0.8) << yaw;
    EXPECT_NEAR(iris->radius_mm, 5.7, 0.25) << yaw;
  }
}

TEST(FindIris, SeesNothingInAClosedEye) {
  FaceCrop crop = EyeCrop(TestPose(0), 0, 0, 5.8);
  std::fill(crop.grey.data.begin(), crop.grey.data.end(), std::uint8_t(150));
  EXPECT_FALSE(FindIris(crop, TestCamera(), TestPose(0), kApex, kPd));
  EXPECT_FALSE(FindIris(EyeCrop(TestPose(60), 0, 0, 5.8), TestCamera(), TestPose(60), kApex, kPd));
}

TEST(SummariseIrises, MeasuresTheDistanceByTheIrisesOwnSize) {
  const Eigen::Vector3d behind(0, 0, -2.3), half(kPd / 2, 0, 0);
  std::vector<IrisReading> readings;
  std::vector<Eigen::Isometry3d> poses;
  for (const double yaw : {-8.0, -3.0, 0.0, 4.0, 9.0}) {
    poses.push_back(TestPose(yaw));
    IrisReading reading;
    reading.right = Iris{TestCamera().Project(poses.back() * (-half + behind)), 5.4, 50};
    reading.left = Iris{TestCamera().Project(poses.back() * (half + behind)), 5.4, 50};
    readings.push_back(reading);
  }
  readings.emplace_back();
  poses.push_back(TestPose(0));
  const auto summary = SummariseIrises(readings, TestCamera(), poses, {-half, half});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->frames, 5);
  EXPECT_NEAR(summary->pupils.distance(), kPd, 1e-9);
  EXPECT_NEAR(summary->diameter_mm, 10.8, 1e-12);
  EXPECT_NEAR(summary->pd_mm, kPd * kIrisDiameterMm / 10.8, 1e-9);
  // No scatter here: what remains is how much people differ.
  EXPECT_NEAR(summary->pd_sigma_mm / summary->pd_mm, kIrisDiameterSigmaMm / kIrisDiameterMm, 1e-9);
}

TEST(SummariseIrises, NeedsThreeFrames) {
  const std::vector<IrisReading> none(10);
  const std::vector<Eigen::Isometry3d> poses(10, TestPose(0));
  EXPECT_FALSE(SummariseIrises(none, TestCamera(), poses, {-kApex, kApex}));
}

}  // namespace
}  // namespace lorgnette
