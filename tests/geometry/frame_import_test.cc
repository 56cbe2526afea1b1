// SPDX-License-Identifier: Apache-2.0
#include "geometry/frame_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <sstream>

#include "cmake/source_dir.h"
#include "geometry/closed_curve.h"
#include "geometry/contour.h"
#include "geometry/cut_lens.h"
#include "geometry/frame_axes.h"
#include "geometry/frame_io.h"
#include "optics/certify.h"
#include "optics/design.h"

namespace lorgnette {
namespace {

// One of our frames as a nameless model in other axes and units.
ModelFile AsModel(const FrameModel& frame, const Eigen::Matrix3d& turn) {
  ModelFile model;
  for (const FramePart& part : frame.parts) {
    ModelPart to;
    to.name = "object" + std::to_string(model.parts.size());
    to.mesh = part.mesh;
    for (Eigen::Vector3d& p : to.mesh.positions) p = turn * p;
    for (Eigen::Vector3d& n : to.mesh.normals) n = (turn * n).normalized();
    model.parts.push_back(std::move(to));
  }
  return model;
}

Eigen::Matrix3d Axes(int x, int y, int z, double sx, double sy, double sz) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  m(x, 0) = sx;
  m(y, 1) = sy;
  m(z, 2) = sz;
  return m;
}

TEST(ImportFrame, FindsAxesUnitAndBoxingOfOurFramesInAnyOrientation) {
  const std::pair<const char*, Eigen::Matrix3d> cases[] = {
      {"rectangle", Axes(0, 1, 2, 1, 1, 1)},         // as it is
      {"aviator", 0.1 * Axes(1, 2, 0, 1, 1, 1)},     // cm, turned in a cycle
      {"round", 0.001 * Axes(0, 2, 1, 1, 1, -1)},    // m, z up
      {"cat-eye", Axes(0, 1, 2, -1, 1, -1) / 25.4},  // inch, looking back
  };
  for (const auto& [name, turn] : cases) {
    ASSERT_GT(turn.determinant(), 0) << name;
    const FrameModel truth = *LoadFrame(name);
    const auto frame = ImportFrame(AsModel(truth, turn), name);
    ASSERT_TRUE(frame.has_value()) << frame.error().message;
    // The openings are traced in the imported mesh: its bound, twice for a width.
    EXPECT_NEAR(frame->boxing.a_mm, truth.boxing.a_mm, 2 * kContourError_mm) << name;
    EXPECT_NEAR(frame->boxing.b_mm, truth.boxing.b_mm, 2 * kContourError_mm) << name;
    EXPECT_NEAR(frame->boxing.dbl_mm, truth.boxing.dbl_mm, 4 * kContourError_mm) << name;
    EXPECT_NEAR(frame->pantoscopic_tilt_deg, truth.pantoscopic_tilt_deg, 1.5) << name;
    EXPECT_NEAR(frame->face_form_deg, truth.face_form_deg, 0.5) << name;
    EXPECT_NEAR(frame->temple_length_mm, truth.temple_length_mm, 15) << name;
    EXPECT_NEAR(frame->ear_point_left.z(), truth.ear_point_left.z(), 15) << name;
    EXPECT_GT(frame->ear_point_left.x(), 60) << name;
    EXPECT_FALSE(frame->nose_contacts.empty()) << name;
    EXPECT_FALSE(frame->notes.empty()) << name;  // the unit was guessed, and that is told
  }
}

TEST(ImportFrame, RefusesAModelWithoutRims) {
  ModelFile model;
  model.parts.emplace_back();
  TriangleMesh& mesh = model.parts[0].mesh;
  mesh.positions = {{0, 0, 0}, {140, 0, 0}, {0, 40, 0}, {0, 0, 140}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  const auto frame = ImportFrame(model, "block.stl");
  ASSERT_FALSE(frame.has_value());
  EXPECT_THAT(frame.error().message, testing::HasSubstr("block.stl: no closed rim"));
}

TEST(ImportFrame, FindsAFrameTurnedAnyWayInSpace) {
  const FrameModel truth = *LoadFrame("rectangle");
  const Eigen::Matrix3d turn(
      Eigen::AngleAxisd(2.2, Eigen::Vector3d(0.4, -0.7, 0.5).normalized()).toRotationMatrix());
  const auto frame = ImportFrame(AsModel(truth, 0.1 * turn), "turned.stl", 10.0);
  ASSERT_TRUE(frame.has_value()) << frame.error().message;
  EXPECT_THAT(frame->notes, testing::Contains(testing::HasSubstr("turned:")));
  EXPECT_NEAR(frame->boxing.a_mm, truth.boxing.a_mm, 2 * kContourError_mm);
  EXPECT_NEAR(frame->boxing.b_mm, truth.boxing.b_mm, 2 * kContourError_mm);
  EXPECT_NEAR(frame->boxing.dbl_mm, truth.boxing.dbl_mm, 4 * kContourError_mm);
  EXPECT_NEAR(frame->pantoscopic_tilt_deg, truth.pantoscopic_tilt_deg, 1.5);
  EXPECT_LT(frame->ear_point_left.z(), -70);  // the temples lie behind
  EXPECT_LT(frame->ear_point_left.y(), 0);    // and fall
}

// Our frame with flat-edged demo lenses cut to it, and without the rims' triangles that `drop`
// names (frame coordinates of a corner).
template <typename Drop>
ModelFile WithLenses(const FrameModel& frame, const char* lens_name, const Drop& drop) {
  ModelFile model;
  for (const FramePart& part : frame.parts) {
    ModelPart to{part.name, part.mesh, part.material, false};
    if (part.name.find("rim") != std::string::npos) {
      std::erase_if(to.mesh.triangles, [&](const Eigen::Vector3i& t) {
        return drop(part.mesh.positions[std::size_t(t[0])]);
      });
    }
    if (!to.mesh.empty()) model.parts.push_back(std::move(to));
  }
  for (const LensOpening* opening : {&frame.right, &frame.left}) {
    LensOrder order;
    order.contour_mm = ContourInLensFrame(opening->contour_mm, {0, 0});
    order.medium.index_d = 1.5;
    CutOptions options;
    options.edge = EdgeForm::kFlat;
    const auto cut = CutAndMount(*Certify(*DesignLens(order)), *opening, {0, 0}, options);
    ModelPart lens;
    lens.name = lens_name;
    lens.mesh = cut->mesh;
    for (Eigen::Vector3d& p : lens.mesh.positions) p = cut->frame_from_lens * p;
    for (Eigen::Vector3d& n : lens.mesh.normals) n = cut->frame_from_lens.linear() * n;
    model.parts.push_back(std::move(lens));
  }
  return model;
}

// The lens mesh has 360 points around its edge: chords of 0.4 mm on a corner of 8 mm radius leave
// 0.003 mm, and the spline's own bound comes on top.
constexpr double kLensOutlineError_mm = 2 * kContourError_mm;

TEST(ImportFrame, TakesTheShapeOfAHalfRimFromItsDemoLenses) {
  const FrameModel truth = *LoadFrame("rectangle");
  const ModelFile model =
      WithLenses(truth, "demo lens", [](const Eigen::Vector3d& p) { return p.y() < 6; });
  const auto frame = ImportFrame(model, "nylon", 1.0);
  ASSERT_TRUE(frame.has_value()) << frame.error().message;
  EXPECT_EQ(frame->mount, FrameMount::kHalfRim);
  EXPECT_NEAR(frame->boxing.a_mm, truth.boxing.a_mm, 2 * kLensOutlineError_mm);
  EXPECT_NEAR(frame->boxing.b_mm, truth.boxing.b_mm, 2 * kLensOutlineError_mm);
  EXPECT_NEAR(frame->boxing.dbl_mm, truth.boxing.dbl_mm, 4 * kLensOutlineError_mm);
  for (const FramePart& part : frame->parts) {
    EXPECT_THAT(part.name, testing::Not(testing::HasSubstr("demo")));
  }
  EXPECT_FALSE(frame->nose_contacts.empty());
}

TEST(ImportFrame, TakesTheShapeOfRimlessGlassesFromUnnamedLenses) {
  const FrameModel truth = *LoadFrame("round");
  const ModelFile model = WithLenses(truth, "object", [](const Eigen::Vector3d&) { return true; });
  const auto frame = ImportFrame(model, "rimless", 1.0);
  ASSERT_TRUE(frame.has_value()) << frame.error().message;
  EXPECT_EQ(frame->mount, FrameMount::kRimless);
  EXPECT_NEAR(frame->boxing.a_mm, truth.boxing.a_mm, 2 * kLensOutlineError_mm);
  EXPECT_NEAR(frame->boxing.dbl_mm, truth.boxing.dbl_mm, 4 * kLensOutlineError_mm);
}

TEST(ImportFrame, RepairsADirtyFrameAndTellsWhatItDid) {
  const FrameModel truth = *LoadFrame("panto");
  ModelFile model = AsModel(truth, Eigen::Matrix3d::Identity());
  for (ModelPart& part : model.parts) {
    TriangleMesh& mesh = part.mesh;
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 9) {
      std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
    }
    mesh.triangles.push_back(mesh.triangles[0]);
    mesh.triangles.emplace_back(0, 0, 1);
    if (mesh.triangles.size() > 5000) {  // a rim: a hole in its back
      mesh.triangles.erase(mesh.triangles.begin() + 41);
    }
  }
  const auto frame = ImportFrame(model, "dirty", 1.0);
  ASSERT_TRUE(frame.has_value()) << frame.error().message;
  EXPECT_THAT(frame->notes, testing::Contains(testing::HasSubstr("turned to face outward")));
  EXPECT_THAT(frame->notes, testing::Contains(testing::HasSubstr("given twice dropped")));
  EXPECT_THAT(frame->notes, testing::Contains(testing::HasSubstr("filled")));
  EXPECT_NEAR(frame->boxing.a_mm, truth.boxing.a_mm, 2 * kContourError_mm);
  EXPECT_NEAR(frame->boxing.b_mm, truth.boxing.b_mm, 2 * kContourError_mm);
}

TEST(ImportFrame, DoesNotBelieveAUnitThatMakesADollsFrame) {
  const FrameModel truth = *LoadFrame("round");
  const auto tiny = ImportFrame(AsModel(truth, 0.4 * Eigen::Matrix3d::Identity()), "doll", 1.0);
  ASSERT_TRUE(tiny.has_value()) << tiny.error().message;
  EXPECT_THAT(tiny->notes, testing::Contains(testing::HasSubstr("not believed")));
}

TEST(MirrorShare, IsWholeAcrossTheMiddleOfASymmetricMesh) {
  const FrameModel frame = *LoadFrame("panto");
  TriangleMesh all;
  for (const FramePart& part : frame.parts) Append(all, part.mesh);
  EXPECT_GT(MirrorShare(all, 0), 0.95);
  EXPECT_LT(MirrorShare(all, 2), 0.5);
}

std::string Shared(const char* file) {
  return std::string(LORGNETTE_SOURCE_DIR "/../shared/data/frames/") + file;
}

TEST(ImportFrame, ReadsSunglassesInMetresAndTakesTheirLensesOut) {
  const std::string path = Shared("SunglassesKhronos.glb");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  const auto frame = LoadFrame(path);
  ASSERT_TRUE(frame.has_value()) << frame.error().message;
  EXPECT_NEAR(frame->boxing.a_mm + frame->boxing.dbl_mm, 76.5, 1.5);
  EXPECT_GT(frame->boxing.b_mm, 50);
  EXPECT_NEAR(frame->temple_length_mm, 160, 15);
  EXPECT_THAT(frame->notes, testing::Contains(testing::HasSubstr("LensesInterior")));
  for (const FramePart& part : frame->parts) {
    EXPECT_THAT(part.name, testing::Not(testing::HasSubstr("Lenses")));
  }
}

TEST(ImportFrame, ReadsGlassesOfUnknownUnitWithUnnamedLenses) {
  const std::string path = Shared("jeeliz_glasses.obj");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  const auto frame = LoadFrame(path);
  ASSERT_TRUE(frame.has_value()) << frame.error().message;
  EXPECT_THAT(frame->notes, testing::Contains(testing::HasSubstr("unit guessed")));
  EXPECT_THAT(frame->notes, testing::Contains(testing::HasSubstr("Plane003")));
  EXPECT_GT(frame->boxing.a_mm, 45);
  EXPECT_LT(frame->boxing.a_mm, 60);
  // With the unit given the same file measures in proportion.
  const auto given = LoadFrame(path, 0.7);
  ASSERT_TRUE(given.has_value());
  EXPECT_NEAR(given->boxing.a_mm / frame->boxing.a_mm, 0.7 * 201 / 140, 0.02);
}

TEST(ParseObj, ReadsPolygonsAndNegativeIndices) {
  const auto model =
      ParseObj("o plate\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2 -1\n", "a.obj");
  ASSERT_TRUE(model.has_value());
  ASSERT_EQ(model->parts.size(), 1u);
  EXPECT_EQ(model->parts[0].name, "plate");
  EXPECT_EQ(model->parts[0].mesh.triangles.size(), 2u);
  EXPECT_NEAR(model->parts[0].mesh.normals[0].z(), 1, 1e-12);
}

TEST(ParseObj, BeginsAPartAtEachMaterial) {
  const auto model = ParseObj(
      "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl steel\nf 1 2 3\nusemtl glass\nf 1 3 2\n", "a.obj");
  ASSERT_TRUE(model.has_value());
  ASSERT_EQ(model->parts.size(), 2u);
  EXPECT_THAT(model->parts[1].name, testing::HasSubstr("glass"));
}

TEST(ParseObj, NamesTheLineThatIsBroken) {
  const auto far = ParseObj("v 0 0 0\nf 1 2 3\n", "a.obj");
  ASSERT_FALSE(far.has_value());
  EXPECT_THAT(far.error().message, testing::HasSubstr("a.obj:2"));
  EXPECT_FALSE(ParseObj("v 0 zero 0\n", "a.obj").has_value());
}

TEST(ParseStl, ReadsTextAndBinaryAlike) {
  const std::string text =
      "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
      "endloop\nendfacet\nendsolid\n";
  const auto ascii = ParseStl(text, "t.stl");
  ASSERT_TRUE(ascii.has_value());
  std::string binary(84 + 50, '\0');
  binary[80] = 1;
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::copy_n(reinterpret_cast<const char*>(corners), sizeof corners, binary.begin() + 84 + 12);
  const auto packed = ParseStl(binary, "t.stl");
  ASSERT_TRUE(packed.has_value());
  EXPECT_EQ(ascii->parts[0].mesh.positions, packed->parts[0].mesh.positions);
  EXPECT_FALSE(ParseStl(binary.substr(0, 100), "t.stl").has_value());
}

TEST(ParsePly, ReadsTextAndBinaryAlike) {
  const std::string head =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  const auto ascii =
      ParsePly("ply\nformat ascii 1.0\n" + head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "p");
  ASSERT_TRUE(ascii.has_value()) << ascii.error().message;
  std::string bytes = "ply\nformat binary_little_endian 1.0\n" + head;
  const float points[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  bytes.append(reinterpret_cast<const char*>(points), sizeof points);
  bytes.push_back(3);
  const int corners[3] = {0, 1, 2};
  bytes.append(reinterpret_cast<const char*>(corners), sizeof corners);
  const auto packed = ParsePly(bytes, "p");
  ASSERT_TRUE(packed.has_value()) << packed.error().message;
  EXPECT_EQ(ascii->parts[0].mesh.positions, packed->parts[0].mesh.positions);
  EXPECT_EQ(ascii->parts[0].mesh.triangles, packed->parts[0].mesh.triangles);
  EXPECT_FALSE(ParsePly(bytes.substr(0, bytes.size() - 2), "p").has_value());
  EXPECT_FALSE(ParsePly("ply\nelement vertex 99999999999\n", "p").has_value());
}

TEST(ParseGltf, RefusesBytesThatAreNone) {
  EXPECT_FALSE(ParseGltf("glTF", "x.glb", "").has_value());
  EXPECT_FALSE(ParseGltf("{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":7}]}", "x.gltf", "")
                   .has_value());
}

}  // namespace
}  // namespace lorgnette
