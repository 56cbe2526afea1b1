// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_zmx.h"

#include <fmt/format.h>

#include <cmath>

#include "apps/lens_text.h"
#include "optics/media.h"
#include "optics/paraxial.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

constexpr double kMicrometres = 1e-3;
constexpr double kFields_deg[] = {0, 10, 20, 30};
constexpr double kPupil_mm = 4;      // entrance pupil of the beam
constexpr double kWeakest_D = 1e-6;  // weaker: the image lies kFarImage_mm away
constexpr double kFarImage_mm = 1000;

class ZmxWriter {
 public:
  void Line(const std::string& text) { text_ += text + "\n"; }

  // `thickness`: to the next surface, a number or INFINITY.
  void Surface(const std::string& type, double curvature, const std::string& thickness,
               const std::string& more = "") {
    Line(fmt::format("SURF {}", count_++));
    Line("  TYPE " + type);
    Line(fmt::format("  CURV {}", curvature));
    Line("  DISZ " + thickness);
    if (!more.empty()) text_ += more;
  }
  // New axes: the columns of `turn`. Tilts about x, then y, then z, each about the axes that the
  // former left: turn = Rx Ry Rz.
  void Break(const Eigen::Matrix3d& turn, const std::string& thickness) {
    const double tilts[] = {std::atan2(-turn(1, 2), turn(2, 2)), std::asin(turn(0, 2)),
                            std::atan2(-turn(0, 1), turn(0, 0))};
    std::string parameters;
    // Adding 0 turns -0 into 0.
    for (int i = 0; i < 3; ++i) parameters += Parameter(3 + i, DegreesFromRadians(tilts[i]) + 0.0);
    Surface("COORDBRK", 0, thickness, parameters);
  }
  static std::string Parameter(int number, double value) {
    return fmt::format("  PARM {} {}\n", number, value);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  int count_ = 0;
};

// What a lens surface is in the file, and the turn about z that brings its generator to y.
struct Shape {
  std::string type = "STANDARD", more;
  double curvature = 0, turn = 0;
};

Result<Shape> ShapeOf(const Surface& surface) {
  Shape shape;
  if (const auto* sphere = std::get_if<SphereSurface>(&surface.shape())) {
    shape.curvature = sphere->curvature;
    return shape;
  }
  if (const auto* torus = std::get_if<TorusSurface>(&surface.shape())) {
    shape.type = "TOROIDAL";
    shape.curvature = torus->curvature_generator;
    // Radius of rotation; 0 stands for infinite.
    shape.more =
        ZmxWriter::Parameter(1, torus->curvature_across == 0 ? 0 : 1 / torus->curvature_across);
    shape.turn = torus->generator_angle - kPi / 2;
    return shape;
  }
  if (const auto* conic = std::get_if<ConicSurface>(&surface.shape())) {
    shape.curvature = conic->curvature;
    shape.more = fmt::format("  CONI {}\n", conic->conic);
    bool even = false;
    for (const double a : conic->even) even = even || a != 0;
    if (!even) return shape;
    shape.type = "EVENASPH";
    for (std::size_t i = 0; i < conic->even.size(); ++i) {
      shape.more += ZmxWriter::Parameter(int(i) + 2, conic->even[i]);  // 1 is the term in r^2
    }
    return shape;
  }
  return UsageError(
      "--zmx: the format has no exact word for this surface, want spheres, tori or conics; "
      "possible: --sdf, which writes any surface as a grid of sags");
}

// One face: `rotation` from its own axes to the lens frame's. `behind`: distance to the next one.
Status WriteFace(const Surface& surface, const Eigen::Matrix3d& rotation, double behind_mm,
                 const std::string& glass, ZmxWriter& out) {
  LG_ASSIGN(const Shape shape, ShapeOf(surface));
  Eigen::Matrix3d turn;
  turn << std::cos(shape.turn), -std::sin(shape.turn), 0, std::sin(shape.turn),
      std::cos(shape.turn), 0, 0, 0, 1;
  const Eigen::Matrix3d whole = rotation * turn;
  const bool turned = !whole.isIdentity(0);
  if (turned) out.Break(whole, "0");
  out.Surface(shape.type, shape.curvature, turned ? "0" : fmt::format("{}", behind_mm),
              shape.more + glass);
  if (turned) out.Break(whole.transpose(), fmt::format("{}", behind_mm));
  return {};
}

}  // namespace

Result<std::string> ZmxOf(const LensDesign& design, double stop_mm) {
  const Lens& lens = design.lens;
  const Medium& medium = lens.medium;
  ZmxWriter out;
  out.Line("VERS 191018 0 0");
  out.Line("MODE SEQ");
  out.Line("NAME " + PowerText(design.order.rx) + ", " + medium.name);
  out.Line("UNIT MM X W X CM MR CPMM");
  out.Line(fmt::format("ENPD {}", kPupil_mm));
  constexpr std::size_t kFields = std::size(kFields_deg);
  out.Line(fmt::format("FTYP 0 0 {} 3 0 0 0 0", kFields));
  std::string x = "XFLN", y = "YFLN", weights = "FWGN";
  for (const double field : kFields_deg) {
    x += " 0";
    y += fmt::format(" {}", field);
    weights += " 1";
  }
  for (const std::string& line : {x, y, weights}) out.Line(line);
  int wave = 1;
  for (const double line_nm : {kLineD_nm, kLineF_nm, kLineC_nm}) {
    out.Line(fmt::format("WAVM {} {} 1", wave++, line_nm * kMicrometres));
  }
  out.Line("PWAV 1");

  out.Surface("STANDARD", 0, "INFINITY");
  const std::string glass =
      fmt::format("  GLAS ___BLANK 1 0 {} {} 0 0 0 0 0 0\n", medium.index_d, medium.abbe);
  const std::string rim = fmt::format("  DIAM {} 1 0 0 1\n", 0.5 * design.order.diameter_mm);
  LG_RETURN_IF_ERROR(WriteFace(lens.front, Eigen::Matrix3d::Identity(), lens.center_thickness_mm,
                               rim + glass, out));
  LG_RETURN_IF_ERROR(WriteFace(lens.back, BackRotation(lens), stop_mm, rim, out));
  const double power = 0.5 * SystemOf(lens).BackVertexPower().trace();
  const double image = std::abs(power) > kWeakest_D ? 1000 / power : kFarImage_mm;
  out.Surface("STANDARD", 0, fmt::format("{}", image - stop_mm), "  STOP\n");
  out.Surface("STANDARD", 0, "0");
  return out.text();
}

}  // namespace lorgnette
