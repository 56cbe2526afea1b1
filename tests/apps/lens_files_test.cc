// SPDX-License-Identifier: Apache-2.0
// What `lorgnette lens` writes beside its sheet, read back by other means: STL and glTF by the
// model readers, Zemax files by a reader of the tests that traces them.
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "apps/lens_zmx.h"
#include "base/units.h"
#include "geometry/model_file.h"
#include "optics/paraxial.h"
#include "optics/power_vector.h"
#include "optics/trace.h"
#include "tests/apps/program_test_util.h"
#include "tests/apps/zmx_reader.h"

namespace lorgnette {
namespace {

using testing::HasSubstr;

// Volume of a mesh by the divergence theorem, and how many of its edges lack their opposite.
struct Solid {
  double volume_mm3 = 0;
  int open_edges = 0;
};
Solid SolidOf(const TriangleMesh& mesh, double mm_per_unit) {
  Solid solid;
  using Key = std::array<double, 6>;
  std::map<Key, int> edges;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    Eigen::Vector3d p[3];
    for (int k = 0; k < 3; ++k) p[k] = mm_per_unit * mesh.positions[std::size_t(t[k])];
    solid.volume_mm3 += p[0].dot(p[1].cross(p[2])) / 6;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d &a = p[k], &b = p[(k + 1) % 3];
      ++edges[Key{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}];
      --edges[Key{b.x(), b.y(), b.z(), a.x(), a.y(), a.z()}];
    }
  }
  for (const auto& [key, count] : edges) solid.open_edges += count != 0;
  return solid;
}

// Triangles of 1.5 mm cut a sphere of 50 mm by 1.5^2 / (8 x 50) mm at most, of a lens some 3 mm
// thick: below 0.4 per cent, on both faces with opposite signs.
constexpr double kFacetsRelative = 4e-3;

class LensFilesTest : public ProgramTest {
 protected:
  std::string Content(const std::string& name) {
    const auto text = ReadFile(Path(name));
    EXPECT_TRUE(text) << name;
    return text.value_or("");
  }
};

TEST_F(LensFilesTest, StlIsClosedAndHasTheVolumeOfItsLens) {
  const Ran ran = Run({"lens", "--sphere", "-4", "--cylinder", "-2", "--axis", "30", "--prism-in",
                       "2", "--stl", Path("lens.stl"), "--json"});
  ASSERT_EQ(ran.code, kExitOk) << ran.err;
  const auto model = ParseStl(Content("lens.stl"), "lens.stl");
  ASSERT_TRUE(model) << model.error().message;
  const Solid solid = SolidOf(model->parts.at(0).mesh, 1);
  EXPECT_EQ(solid.open_edges, 0);
  const auto json = ran.Json();
  const double volume = 1000 * double(json["mass_g"]) / double(json["order"]["density_g_cm3"]);
  EXPECT_NEAR(solid.volume_mm3, volume, kFacetsRelative * volume);
}

TEST_F(LensFilesTest, PairsGetAnStlEach) {
  ASSERT_EQ(Run({"lens", kTable1, "--stl", Path("table.stl")}).code, kExitOk);
  EXPECT_EQ(FilesHere(), (std::vector<std::string>{"table_left.stl", "table_right.stl"}));
}

TEST_F(LensFilesTest, GlbHoldsThePairWithItsMaterialAndOrder) {
  const Ran ran = Run({"lens", kTable1, "--medium", "1.67", "--glb", Path("pair.glb"), "--json"});
  ASSERT_EQ(ran.code, kExitOk) << ran.err;
  const std::string glb = Content("pair.glb");
  const auto model = ParseGltf(glb, "pair.glb", folder_);
  ASSERT_TRUE(model) << model.error().message;
  ASSERT_EQ(model->parts.size(), 2u);
  const auto lenses = ran.Json()["lenses"];
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(model->parts[i].transparent);
    // Positions are floats of metres, moved by half the PD: 4e-9 m of rounding.
    Eigen::Vector3d low(1, 1, 1), high(-1, -1, -1);
    for (const Eigen::Vector3d& p : model->parts[i].mesh.positions) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    EXPECT_NEAR(0.5 * (low.x() + high.x()), i == 0 ? -0.032 : 0.032, 1e-7);
    EXPECT_NEAR(high.x() - low.x(), 0.060, 1e-5);  // 360 points around the edge
    const Solid solid = SolidOf(model->parts[i].mesh, 1000);
    const double volume =
        1000 * double(lenses[i]["mass_g"]) / double(lenses[i]["order"]["density_g_cm3"]);
    EXPECT_NEAR(solid.volume_mm3, volume, kFacetsRelative * volume);
  }
  // The chunk of JSON, by the format's header.
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  const auto json = nlohmann::json::parse(glb.substr(20, length));
  const auto material = json["materials"][0]["extensions"];
  EXPECT_EQ(material["KHR_materials_ior"]["ior"], 1.66);
  EXPECT_EQ(material["KHR_materials_dispersion"]["dispersion"], 20.0 / 32);
  EXPECT_EQ(material["KHR_materials_transmission"]["transmissionFactor"], 1);
  EXPECT_DOUBLE_EQ(material["KHR_materials_volume"]["thicknessFactor"],
                   double(lenses[0]["center_thickness_mm"]) / 1000);
  EXPECT_EQ(json["nodes"][0]["extras"]["order"]["sphere_D"], -4.25);
  EXPECT_EQ(json["nodes"][1]["extras"]["order"]["sphere_D"], -4.5);
}

// Where a ray meets the stop's plane, by the file and by the lens.
void ExpectSameRays(const LensOrder& order) {
  constexpr double kStop_mm = 27;
  const auto design = DesignLens(order);
  ASSERT_TRUE(design) << design.error().message;
  const auto text = ZmxOf(*design, kStop_mm);
  ASSERT_TRUE(text) << text.error().message;
  const zmx::System system = zmx::System::Read(*text);
  const Lens& lens = design->lens;
  const double plane = lens.center_thickness_mm + kStop_mm;
  int compared = 0;
  for (const double x : {-11.0, 0.0, 4.0}) {
    for (const double y : {-7.0, 0.0, 12.0}) {
      for (const double slope : {-0.3, 0.0, 0.2}) {
        const Eigen::Vector3d d = Eigen::Vector3d(slope, 0.5 * slope + 0.1, 1).normalized();
        const LensTrace ray = TraceThrough(lens, {{x, y, 0}, d}, order.medium.index_d);
        if (ray.status != RayStatus::kOk) continue;
        const Eigen::Vector3d at = ray.exit.origin + (plane - ray.exit.origin.z()) /
                                                         ray.exit.direction.z() *
                                                         ray.exit.direction;
        const auto read = system.TraceToStop({zmx::Vec(x, y, 0), d.cast<long double>()});
        // The file's numbers are the lens' own; what is left is rounding of points 30 mm away.
        EXPECT_LT((read.p.cast<double>().head<2>() - at.head<2>()).norm(), 1e-11);
        EXPECT_LT((read.d.cast<double>() - ray.exit.direction).norm(), 1e-12);
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 27);

  // Power of the file's lens: slopes of two narrow beams, brought back to the back vertex.
  constexpr long double h = 3e-3L;  // the third order adds (h / 50)^2 of the power
  Eigen::Matrix2d place, bend;
  for (int k = 0; k < 2; ++k) {
    const zmx::Vec step = h * zmx::Vec::Unit(k), along = zmx::Vec::UnitZ();
    const auto plus = system.TraceToStop({step, along}), minus = system.TraceToStop({-step, along});
    const auto slope = [](const zmx::System::Ray& r) { return (r.d / r.d.z()).eval(); };
    place.col(k) = ((plus.p - minus.p) / (2 * h)).cast<double>().head<2>();
    bend.col(k) = ((slope(plus) - slope(minus)) / (2 * h)).cast<double>().head<2>();
  }
  if (lens.back_tilt_x != 0 || lens.back_tilt_y != 0) return;
  const Eigen::Matrix2d power = -1000 * bend * (place - kStop_mm * bend).inverse();
  EXPECT_LT((power - SystemOf(lens).BackVertexPower()).norm(), 1e-7);
  const PowerVector wanted = PowerVectorOf({order.rx.sphere, order.rx.cylinder, order.rx.axis});
  EXPECT_LT((power - LensFrameMatrix(wanted)).norm(), 1e-7);
}

LensOrder Order(double sphere, double cylinder, double axis) {
  LensOrder order;
  order.rx.sphere = Diopters(sphere);
  order.rx.cylinder = Diopters(cylinder);
  order.rx.axis = AxisDegrees(axis);
  order.diameter_mm = 50;
  return order;
}

TEST(LensZmx, TracesAsTheLensItself) {
  ExpectSameRays(Order(-6, 0, 180));
  ExpectSameRays(Order(-4, -3, 150));
  ExpectSameRays(Order(3, 2, 35));
  LensOrder order = Order(-2, -4, 70);
  order.generator = ToricGenerator::kAlongMinusAxis;
  ExpectSameRays(order);
  order = Order(1, -5, 20);
  order.toric_side = ToricSide::kFront;
  ExpectSameRays(order);
  order = Order(4, 0, 180);
  order.aspheric_gaze_deg = 25;
  ExpectSameRays(order);
  order = Order(-3, -2, 110);
  order.rx.prism_in = PrismDiopters(3);
  order.rx.prism_up = PrismDiopters(-2);
  ExpectSameRays(order);
}

TEST_F(LensFilesTest, ZmxOfAPairAndWhatItCannotSay) {
  ASSERT_EQ(Run({"lens", kTable1, "--zmx", Path("pair.zmx")}).code, kExitOk);
  EXPECT_EQ(FilesHere(), (std::vector<std::string>{"pair_left.zmx", "pair_right.zmx"}));
  const std::string text = Content("pair_right.zmx");
  for (const char* line : {"MODE SEQ", "UNIT MM", "WAVM 1 0.58756", "  TYPE TOROIDAL",
                           "  GLAS ___BLANK 1 0 1.498 58", "  STOP"}) {
    EXPECT_THAT(text, HasSubstr(line));
  }
  const Ran refused = Run({"lens", "--sphere", "1", "--add", "2", "--multifocal", "progressive",
                           "--zmx", Path("no.zmx")});
  EXPECT_EQ(refused.code, kExitUsage);
  EXPECT_THAT(refused.err, HasSubstr("possible: --sdf"));
  EXPECT_EQ(FilesHere().size(), 2u);
}

TEST_F(LensFilesTest, SdfComesBackAsTheSameLens) {
  const auto ordered = Run({"lens", "--sphere", "-3", "--cylinder", "-1.5", "--axis", "30",
                            "--diameter", "40", "--sdf", Path("lens.sdf"), "--json"})
                           .Json();
  const double t = ordered["center_thickness_mm"];
  Write("lens.json", R"({"index": 1.498, "density": 1.32, "diameter": 40, "center_thickness": )" +
                         std::to_string(t) + R"(,
      "front": {"form": "sdf", "file": "lens.sdf"}, "back": {"form": "sdf", "file": "lens.sdf"}})");
  const Ran ran = Run({"measure", "--lens", Path("lens.json"), "--gaze", "20,40"});
  ASSERT_EQ(ran.code, kExitOk) << ran.err;
  const auto measured = ran.Json();
  // A bicubic spline on nodes of 0.5 mm: curvature to h^2 / 12 of its second derivative, 1e-5 D.
  EXPECT_NEAR(measured["order"]["sphere_D"], -3, 1e-4);
  EXPECT_NEAR(measured["order"]["cylinder_D"], -1.5, 1e-4);
  EXPECT_NEAR(measured["order"]["axis_deg"], 30, 1e-3);
  EXPECT_NEAR(measured["edge_thickness_mm"], double(ordered["edge_thickness_mm"]), 1e-5);
  const auto gazed = Run({"measure", "--sphere", "-3", "--cylinder", "-1.5", "--axis", "30",
                          "--diameter", "40", "--gaze", "20,40"})
                         .Json();
  EXPECT_NEAR(measured["tangential_D"], double(gazed["tangential_D"]), 1e-3);
}

}  // namespace
}  // namespace lorgnette
