// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_surfaces.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "base/atomic_file.h"
#include "base/json_reader.h"
#include "optics/outline.h"
#include "optics/paraxial.h"
#include "optics/power_vector.h"
#include "optics/sdf.h"

namespace lorgnette {
namespace {

constexpr double kMaxRadius_mm = 1e9;
constexpr double kNoCylinder_D = 1e-9;  // rounding of a sphere, at most

double CurvatureOf(double radius_mm) { return std::isinf(radius_mm) ? 0 : 1 / radius_mm; }

// A TABO meridian M points along (-cos M, sin M) in the lens frame: at 180 - M from +x.
double AngleOf(AxisDegrees meridian) { return kPi - meridian.radians(); }

// Curvatures along and across the axis. The minus axis of a back surface is the meridian of the
// smaller curvature, of a front one that of the greater.
Surface TorusOf(double along, double across, AxisDegrees axis, bool front,
                ToricGenerator generator) {
  if (along == across) return SphereSurface{along};
  const bool minus_axis_along = (along < across) != front;
  const bool along_generates = minus_axis_along == (generator == ToricGenerator::kAlongMinusAxis);
  if (along_generates) return TorusSurface{along, across, AngleOf(axis)};
  return TorusSurface{across, along, AngleOf(axis) + kPi / 2};
}

// Fills in what follows from the surfaces: the order that the lens amounts to, thickness, weight.
// `axis`: the meridian that "along" means; absent: the minus axis of the back vertex power.
Result<LensDesign> DesignOf(const Lens& lens, const LensOptions& o,
                            std::optional<AxisDegrees> axis) {
  LensDesign design;
  design.lens = lens;
  LensOrder& order = design.order;
  order.eye = o.eye == "left" ? Eye::kLeft : Eye::kRight;
  order.medium = lens.medium;
  order.center_thickness_mm = lens.center_thickness_mm;
  order.diameter_mm = o.diameter_mm;
  order.vertex_distance_mm = o.vertex_distance_mm.value_or(kDefaultVertex_mm);

  const double n = lens.medium.index_d;
  const Eigen::Matrix2d power = SystemOf(lens).BackVertexPower();
  SphereCylinder form;
  if (power.allFinite()) form = MinusCylinderForm(PowerVectorOfLensFrame(power));
  if (std::abs(form.cylinder.value()) < kNoCylinder_D) form.cylinder = Diopters(0);
  order.rx.axis = axis.value_or(form.axis);
  const Eigen::Vector2d along = LensFrameDirection(order.rx.axis), across(-along.y(), along.x());
  const Eigen::Matrix2d front = SurfacePower(lens.front, 1, n),
                        back = SurfacePower(lens.back, n, 1);
  if (power.allFinite()) {
    order.rx.sphere = Diopters(along.dot(power * along));
    order.rx.cylinder = form.cylinder == Diopters(0)
                            ? Diopters(0)
                            : Diopters(across.dot(power * across)) - order.rx.sphere;
  }
  design.front_power = Diopters(along.dot(front * along));
  design.back_power_axis = Diopters(along.dot(back * along));
  design.back_power_across = Diopters(across.dot(back * across));
  order.base_curve = design.front_power;

  const Outline outline = Outline::Round(o.diameter_mm);
  const std::optional<EdgeThickness> edge = EdgeOver(design.lens, outline);
  if (!edge) {
    return Failure(fmt::format(
        "lens: a surface has no real sag over a diameter of {} mm; possible: a smaller --diameter",
        o.diameter_mm));
  }
  if (edge->least_inside_mm < 0) {
    return Failure(
        fmt::format("lens: the surfaces cross inside a diameter of {} mm; possible: a "
                    "thicker or a smaller lens",
                    o.diameter_mm));
  }
  design.min_edge_thickness_mm = edge->least_mm;
  design.max_edge_thickness_mm = edge->greatest_mm;
  design.mass_g = MassOver(design.lens, outline);
  design.min_blank_mm = o.diameter_mm + kBlankAllowance_mm;
  return design;
}

// Reads one surface of a lens file.
class SurfaceReader {
 public:
  SurfaceReader(JsonReader json, std::filesystem::path folder, SdfFace face)
      : json_(std::move(json)), folder_(std::move(folder)), face_(face) {}

  Result<Surface> Read() {
    const std::string form = json_.String("form");
    if (form == "sphere") return Surface(SphereSurface{Curvature("radius")});
    if (form == "torus") {
      TorusSurface s;
      s.curvature_generator = Curvature("radius_generator");
      s.curvature_across = Curvature("radius_across");
      s.generator_angle = Meridian("generator_meridian");
      return Surface(s);
    }
    if (form == "conic") {
      ConicSurface s;
      s.curvature = Curvature("radius");
      s.conic = json_.NumberOr("conic", 0, -100, 100);
      const char* names[] = {"a4", "a6", "a8", "a10"};
      for (std::size_t i = 0; i < s.even.size(); ++i) {
        s.even[i] = json_.NumberOr(names[i], 0, -1, 1);
      }
      return Surface(s);
    }
    if (form == "atoroid") {
      AtoroidSurface s;
      s.curvature_generator = Curvature("radius_generator");
      s.curvature_across = Curvature("radius_across");
      s.conic_generator = json_.NumberOr("conic_generator", 0, -100, 100);
      s.conic_across = json_.NumberOr("conic_across", 0, -100, 100);
      s.a4_generator = json_.NumberOr("a4_generator", 0, -1, 1);
      s.generator_angle = Meridian("generator_meridian");
      return Surface(s);
    }
    if (form == "progressive") {
      const double far = Curvature("radius_far"), near = Curvature("radius_near");
      return Surface(ProgressiveSurface(
          far, near - far, json_.NumberOr("start", 0, -30, 0), json_.Number("length", 1, 60),
          RadiansFromDegrees(json_.NumberOr("turn_deg", 0, -45, 45))));
    }
    if (form == "sdf") return ReadSdf();
    json_.Fail("form",
               "got \"" + form + "\", want sphere, torus, conic, atoroid, progressive or sdf");
    return Surface();
  }

 private:
  // Absent or null: plano.
  double Curvature(const char* key) {
    if (!json_.Has(key)) {
      json_.Ignore(key);
      return 0;
    }
    const double radius = json_.Number(key, -kMaxRadius_mm, kMaxRadius_mm);
    if (!(std::abs(radius) >= kMinRadius_mm)) {
      json_.Fail(key, fmt::format("got {}, want at least {} mm (either sign), or null for plano",
                                  radius, kMinRadius_mm));
      return 0;
    }
    return 1 / radius;
  }
  double Meridian(const char* key) { return AngleOf(AxisDegrees(json_.Number(key, 0, 180))); }

  Result<Surface> ReadSdf() {
    const std::string file = json_.String("file");
    SdfOptions options;
    options.first_row_is_top = json_.BoolOr("first_row_is_top", true);
    options.columns_run_to_viewers_right = json_.BoolOr("columns_run_to_viewers_right", true);
    options.sag_toward_eye = json_.BoolOr("sag_toward_eye", true);
    const std::string eye = json_.StringOr("eye", "");
    if (eye != "" && eye != "right" && eye != "left") {
      json_.Fail("eye", "got \"" + eye + "\", want right or left");
    }
    if (file.empty()) return Surface();
    const std::string path = (folder_ / file).string();
    LG_ASSIGN(const std::string text, ReadFile(path));
    LG_ASSIGN(const std::vector<SdfSurface> all, ParseSdf(text, path, options));
    const SdfSurface* found = nullptr;
    for (const SdfSurface& one : all) {
      if (one.face != face_ || (eye != "" && (one.eye == Eye::kRight) != (eye == "right")))
        continue;
      if (found) {
        return UsageError(fmt::format("{}: two surfaces fit, want \"eye\" to choose one", path));
      }
      found = &one;
    }
    if (!found) {
      return UsageError(fmt::format("{}: no {} surface{}", path,
                                    face_ == SdfFace::kFront ? "front (F)" : "back (B)",
                                    eye.empty() ? "" : " of the " + eye + " eye"));
    }
    return found->surface;
  }

  JsonReader json_;
  std::filesystem::path folder_;
  SdfFace face_;
};

}  // namespace

Result<LensDesign> LensFromRadii(const LensOptions& o) {
  LG_RETURN_IF_ERROR(CheckMaking(o));
  if (o.sphere_D) {
    return UsageError("--front-radius: got it together with --sphere, want one of the two");
  }
  if (o.front_radii_mm.empty())
    return UsageError("--front-radius: missing, want the front's radius");
  if (o.back_radii_mm.empty() || o.back_radii_mm.size() > 2) {
    return UsageError("--back-radius: want one radius, or two (along the axis, across it)");
  }
  if (!o.center_thickness_mm) {
    return UsageError("--center-thickness: missing, a lens given by its surfaces needs it");
  }
  if (o.axis_deg) LG_RETURN_IF_ERROR(CheckRange("--axis", *o.axis_deg, 0, 180));
  for (const auto* radii : {&o.front_radii_mm, &o.back_radii_mm}) {
    for (const double radius : *radii) {
      if (std::abs(radius) >= kMinRadius_mm) continue;
      return UsageError(
          fmt::format("--front-radius, --back-radius: got {}, want at least {} mm "
                      "(either sign), or inf",
                      radius, kMinRadius_mm));
    }
  }
  const auto pair = [](const std::vector<double>& radii) {
    return std::pair(CurvatureOf(radii.front()), CurvatureOf(radii.back()));
  };
  const auto front = pair(o.front_radii_mm), back = pair(o.back_radii_mm);
  if ((front.first != front.second || back.first != back.second) && !o.axis_deg) {
    return UsageError("--back-radius: got two radii without --axis, want both");
  }
  LG_ASSIGN(const MediumEntry medium, MediumOf(o));
  const ToricGenerator generator =
      o.generator == "along" ? ToricGenerator::kAlongMinusAxis : ToricGenerator::kAcrossMinusAxis;
  const AxisDegrees axis(o.axis_deg.value_or(180));
  Lens lens;
  lens.medium = medium.medium;
  lens.center_thickness_mm = *o.center_thickness_mm;
  lens.front = TorusOf(front.first, front.second, axis, true, generator);
  lens.back = TorusOf(back.first, back.second, axis, false, generator);
  return DesignOf(lens, o, axis);
}

Result<LensDesign> LensFromFile(const LensOptions& o) {
  if (o.sphere_D || !o.front_radii_mm.empty() || !o.back_radii_mm.empty()) {
    return UsageError("--lens: got it together with --sphere or radii, want one of them");
  }
  LG_ASSIGN(const std::string text, ReadFile(o.lens_file));
  LG_ASSIGN(JsonReader json, JsonReader::Parse(text, o.lens_file));
  LensOptions own = o;
  if (json.Has("medium")) own.medium = json.String("medium");
  if (json.Has("index")) own.index = json.Number("index", 1, 3);
  if (json.Has("abbe")) own.abbe = json.Number("abbe", 10, 100);
  if (json.Has("density")) own.density_g_cm3 = json.Number("density", 0.5, 8);
  own.diameter_mm = json.NumberOr("diameter", o.diameter_mm, 5, 120);
  Lens lens;
  lens.center_thickness_mm = json.Number("center_thickness", 0.1, 40);
  const std::filesystem::path folder = std::filesystem::path(o.lens_file).parent_path();
  LG_ASSIGN(lens.front, SurfaceReader(json.Object("front"), folder, SdfFace::kFront).Read());
  LG_ASSIGN(lens.back, SurfaceReader(json.Object("back"), folder, SdfFace::kBack).Read());
  LG_RETURN_IF_ERROR(json.Finish());
  LG_RETURN_IF_ERROR(CheckMaking(own));
  LG_ASSIGN(const MediumEntry medium, MediumOf(own));
  lens.medium = medium.medium;
  return DesignOf(lens, own, std::nullopt);
}

}  // namespace lorgnette
