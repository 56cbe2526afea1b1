// SPDX-License-Identifier: Apache-2.0
#include "geometry/parametric_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "geometry/closed_curve.h"
#include "geometry/frame_io.h"
#include "geometry/mesh_check.h"

namespace lorgnette {
namespace {

// Boxing of the sampled contour against the parameters: 720 points leave this much of an extreme
// between two of them at a curvature radius of 10 mm (0.2 mm apart: 0.1^2 / 20).
constexpr double kSamplingError_mm = 1e-3;

std::vector<std::string> Names() {
  std::vector<std::string> names;
  const auto frames = ListShippedFrames();
  if (frames) {
    for (const ShippedFrame& frame : *frames) names.push_back(frame.name);
  }
  return names;
}

TEST(ShippedFrames, AreSixAndListedByName) {
  EXPECT_THAT(Names(),
              testing::ElementsAre("aviator", "cat-eye", "hexagon", "panto", "rectangle", "round"));
}

TEST(ShippedFrames, EveryPartIsClosedOrientedAndFreeOfSelfIntersection) {
  for (const std::string& name : Names()) {
    const auto frame = LoadFrame(name);
    ASSERT_TRUE(frame.has_value()) << frame.error().message;
    for (const FramePart& part : frame->parts) {
      if (part.name.starts_with("right")) continue;  // the mirror image of the left
      SCOPED_TRACE(name + ", " + part.name);
      const MeshReport report = CheckMesh(part.mesh, true);
      EXPECT_TRUE(report.closed());
      EXPECT_EQ(report.components, 1);
      EXPECT_EQ(report.degenerate_triangles, 0);
      EXPECT_EQ(report.self_intersections, 0);
      EXPECT_GT(report.volume_mm3, 0);
    }
  }
}

TEST(ShippedFrames, NormalsAreUnitAndOnTheirTrianglesOuterSide) {
  for (const std::string& name : Names()) {
    const auto frame = LoadFrame(name);
    ASSERT_TRUE(frame.has_value());
    for (const FramePart& part : frame->parts) {
      const TriangleMesh& mesh = part.mesh;
      ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
      int against = 0;
      for (const Eigen::Vector3i& t : mesh.triangles) {
        const Eigen::Vector3d& a = mesh.positions[std::size_t(t[0])];
        const Eigen::Vector3d facet = (mesh.positions[std::size_t(t[1])] - a)
                                          .cross(mesh.positions[std::size_t(t[2])] - a)
                                          .normalized();
        Eigen::Vector3d mean(0, 0, 0);
        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(mesh.normals[std::size_t(t[k])].norm(), 1, 1e-12);
          mean += mesh.normals[std::size_t(t[k])];
        }
        against += mean.dot(facet) <= 0;
      }
      EXPECT_EQ(against, 0) << name << ", " << part.name;
    }
  }
}

TEST(ShippedFrames, BoxingIsWhatTheParametersSay) {
  for (const std::string& name : Names()) {
    const auto text = ReadFile(DataDirectory() + "/frames/" + name + ".json");
    ASSERT_TRUE(text.has_value());
    const auto parameters = ParseFrameParameters(*text, name);
    ASSERT_TRUE(parameters.has_value());
    const FrameModel frame = BuildFrame(*parameters);
    EXPECT_NEAR(frame.boxing.a_mm, parameters->a_mm, kSamplingError_mm);
    EXPECT_NEAR(frame.boxing.b_mm, parameters->b_mm, kSamplingError_mm);
    EXPECT_EQ(frame.boxing.dbl_mm, parameters->dbl_mm);
    EXPECT_GT(SignedArea(frame.left.contour_mm), 0);
    EXPECT_GT(SignedArea(frame.right.contour_mm), 0);
    EXPECT_FALSE(frame.nose_contacts.empty());
  }
}

TEST(ShippedFrames, RightIsTheMirrorImageOfLeft) {
  const FrameModel frame = *LoadFrame("cat-eye");
  const Eigen::Isometry3d& left = frame.left.frame_from_opening;
  const Eigen::Isometry3d& right = frame.right.frame_from_opening;
  const std::size_t n = frame.left.contour_mm.size();
  for (std::size_t i = 0; i < n; i += 40) {
    const Eigen::Vector2d &l = frame.left.contour_mm[i], &r = frame.right.contour_mm[n - 1 - i];
    const Eigen::Vector3d a = left * Eigen::Vector3d(l.x(), l.y(), frame.left.groove_height_mm[i]);
    const Eigen::Vector3d b =
        right * Eigen::Vector3d(r.x(), r.y(), frame.right.groove_height_mm[n - 1 - i]);
    EXPECT_NEAR((Eigen::Vector3d(-a.x(), a.y(), a.z()) - b).norm(), 0, 1e-12);
  }
}

TEST(WithBridge, ChangesTheBridgeAndCarriesThePadsAlong) {
  const FrameParameters made = *LoadFrame("rectangle")->parameters;
  const FrameModel wider = BuildFrame(WithBridge(made, made.dbl_mm + 2, 0.5));
  const FrameModel frame = BuildFrame(made);
  EXPECT_EQ(wider.boxing.dbl_mm, frame.boxing.dbl_mm + 2);
  EXPECT_NEAR(wider.boxing.a_mm, frame.boxing.a_mm, 1e-12);
  const auto nearest = [](const FrameModel& f) {
    double x = 1e9;
    for (const Eigen::Vector3d& p : f.nose_contacts) x = std::min(x, std::abs(p.x()));
    return x;
  };
  EXPECT_NEAR(nearest(wider), nearest(frame) + 1.5, 0.2);  // half the change, and half a millimetre
}

TEST(LoadFrame, NamesWhatShipsWhenAskedForSomethingElse) {
  const auto frame = LoadFrame("monocle");
  ASSERT_FALSE(frame.has_value());
  EXPECT_EQ(frame.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(frame.error().message, testing::HasSubstr("aviator"));
}

TEST(ParseFrameParameters, NamesTheKeyThatIsWrong) {
  std::string text = *ReadFile(DataDirectory() + "/frames/round.json");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    const auto parsed = ParseFrameParameters(changed, "round.json");
    return parsed ? std::string("accepted") : parsed.error().message;
  };
  EXPECT_THAT(with("\"A\": 47", "\"A\": 470"), testing::HasSubstr("boxing.A: got 470"));
  EXPECT_THAT(with("\"A\": 47", "\"a\": 47"), testing::HasSubstr("A"));
  EXPECT_THAT(with("\"metal\": {", "\"steel\": {"), testing::HasSubstr("metal"));
  EXPECT_THAT(with("\"outline\": [", "\"outline\": [1, "), testing::HasSubstr("outline"));
}

}  // namespace
}  // namespace lorgnette
