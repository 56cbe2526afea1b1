// SPDX-License-Identifier: Apache-2.0
#include "page_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_reader.h"
#include "optics/media.h"
#include "optics/tint.h"

namespace lorgnette::page {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMaxLength_mm = 1e5;
constexpr double kMaxLean_deg = 40;

// Not-a-number and infinity (a plano radius) have no JSON; they become null.
Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json Pair(const MeridianPair& pair) {
  return Json::array({Number(pair.along), Number(pair.across)});
}

Json Cardinal(const std::optional<CardinalPoints>& points) {
  if (!points) return nullptr;
  return {{"front_focal_mm", Number(points->front_focal_mm)},
          {"back_focal_mm", Number(points->back_focal_mm)},
          {"front_principal_mm", Number(points->front_principal_mm)},
          {"back_principal_mm", Number(points->back_principal_mm)}};
}

std::optional<double> OptionalNumber(JsonReader& json, const char* key, double min, double max) {
  if (!json.Has(key)) return std::nullopt;
  return json.Number(key, min, max);
}

// With the cylinder's sign as the order writes it.
Json FormJson(const PowerVector& power, const EyePrescription& as) {
  const SphereCylinder form =
      as.cylinder > Diopters(0) ? PlusCylinderForm(power) : MinusCylinderForm(power);
  return {{"sphere", form.sphere.value()},
          {"cylinder", form.cylinder.value()},
          {"axis", form.axis.value()}};
}

Json EyeJson(const EyePrescription& rx) {
  return {{"sphere", rx.sphere.value()},     {"cylinder", rx.cylinder.value()},
          {"axis", rx.axis.value()},         {"add", rx.add.value()},
          {"prism_in", rx.prism_in.value()}, {"prism_up", rx.prism_up.value()}};
}

// The multifocal front that `design` names, for an order with an addition.
void ReadDesign(JsonReader& json, LensOrder& order) {
  const std::string design = json.StringOr("design", "single");
  const double corridor = json.NumberOr("corridor_mm", ProgressiveOrder{}.corridor_mm, 6, 30);
  const bool multifocal = order.rx.add.value() > 0;
  if (design == "single") return;
  if (design == "progressive" || design == "soft") {
    if (!multifocal) return;
    order.progressive.emplace();
    order.progressive->corridor_mm = corridor;
    if (design == "soft") order.progressive->design = ProgressiveDesign::kSoft;
    return;
  }
  SegmentOrder segment;
  if (design == "round") {
    segment.shape = SegmentShape::kRound;
    segment.width_mm = 24;
  } else if (design == "executive") {
    segment.shape = SegmentShape::kExecutive;
  } else if (design == "flat35") {
    segment.width_mm = 35;
  } else if (design != "flat28") {
    json.Fail("design", "got " + design +
                            ", want single, round, flat28, flat35, executive, progressive or soft");
  }
  if (multifocal) order.segment = segment;
}

CoatKind ReadCoat(JsonReader& json) {
  const std::string coat = json.StringOr("coat", "none");
  if (coat == "single") return CoatKind::kSingle;
  if (coat == "v") return CoatKind::kVCoat;
  if (coat == "broadband") return CoatKind::kBroadband;
  if (coat != "none") json.Fail("coat", "got " + coat + ", want none, single, v or broadband");
  return CoatKind::kNone;
}

}  // namespace

Result<PageOrder> ReadOrder(const std::string& json_text) {
  LG_ASSIGN(JsonReader json, JsonReader::Parse(json_text, "order"));
  PageOrder page;
  LensOrder& order = page.order;
  const std::string eye = json.StringOr("eye", "right");
  if (eye != "right" && eye != "left") json.Fail("eye", "got " + eye + ", want right or left");
  order.eye = eye == "left" ? Eye::kLeft : Eye::kRight;
  EyePrescription& rx = order.rx;
  rx.sphere = Diopters(json.Number("sphere", -kMaxSphere, kMaxSphere));
  rx.cylinder = Diopters(json.NumberOr("cylinder", 0, -kMaxCylinder, kMaxCylinder));
  rx.axis = AxisDegrees(json.NumberOr("axis", 180, 0, 180));
  rx.add = Diopters(json.NumberOr("add", 0, 0, kMaxAdd));
  rx.prism_in = PrismDiopters(json.NumberOr("prism_in", 0, -kMaxPrism, kMaxPrism));
  rx.prism_up = PrismDiopters(json.NumberOr("prism_up", 0, -kMaxPrism, kMaxPrism));
  ReadDesign(json, order);
  page.coat = ReadCoat(json);
  page.tint = json.NumberOr("tint", 0, 0, 0.96);
  if (json.Has("medium")) {
    JsonReader medium = json.Object("medium");
    order.medium.name = medium.StringOr("name", order.medium.name);
    order.medium.index_d = medium.NumberOr("index_d", order.medium.index_d, 1.3, 2.5);
    order.medium.abbe = medium.NumberOr("abbe", order.medium.abbe, 10, 120);
    order.medium.density_g_cm3 =
        medium.NumberOr("density_g_cm3", order.medium.density_g_cm3, 0.5, 10);
  }
  if (const auto base = OptionalNumber(json, "base_curve_D", -20, 30)) {
    order.base_curve = Diopters(*base);
  }
  order.center_thickness_mm = OptionalNumber(json, "center_thickness_mm", 0.1, 60);
  order.min_center_thickness_mm =
      json.NumberOr("min_center_thickness_mm", order.min_center_thickness_mm, 0.1, 20);
  order.min_edge_thickness_mm =
      json.NumberOr("min_edge_thickness_mm", order.min_edge_thickness_mm, 0, 20);
  order.diameter_mm = json.NumberOr("diameter_mm", order.diameter_mm, 4, 120);
  if (json.Has("contour_mm")) {
    const std::vector<double> flat = json.Numbers("contour_mm");
    if (flat.size() % 2 != 0 || flat.size() < 6) {
      json.Fail("contour_mm", "got " + std::to_string(flat.size()) + " numbers, want x, y pairs");
    }
    for (std::size_t i = 0; i + 1 < flat.size(); i += 2) {
      order.contour_mm.emplace_back(flat[i], flat[i + 1]);
    }
  }
  SheetRequest& request = page.request;
  order.vertex_distance_mm = json.NumberOr("vertex_distance_mm", 13, kMinVertex_mm, kMaxVertex_mm);
  page.wear.vertex_distance_mm = order.vertex_distance_mm;
  page.wear.pantoscopic_deg = json.NumberOr("pantoscopic_deg", 0, -kMaxLean_deg, kMaxLean_deg);
  page.wear.face_form_deg = json.NumberOr("face_form_deg", 0, -kMaxLean_deg, kMaxLean_deg);
  page.refraction_vertex_mm =
      json.NumberOr("refraction_vertex_mm", order.vertex_distance_mm, kMinVertex_mm, kMaxVertex_mm);
  page.compensate = json.BoolOr("compensate", false);
  request.observer.camera_mm =
      json.NumberOr("camera_mm", request.observer.camera_mm, 20, kMaxLength_mm);
  request.observer.depth_mm = json.NumberOr(
      "depth_mm", order.vertex_distance_mm + kEntrancePupilDepth_mm, 0, kMaxLength_mm);
  request.feature_height_mm =
      json.NumberOr("feature_height_mm", request.feature_height_mm, -100, 100);
  request.feature_meridian_deg =
      json.NumberOr("feature_meridian_deg", request.feature_meridian_deg, 0, 180);
  LG_RETURN_IF_ERROR(json.Finish());
  return page;
}

Result<double> Transmittance(const PageOrder& page, double thickness_mm) {
  LensFilter filter;
  filter.index = page.order.medium.index_d;
  filter.front_coat = filter.back_coat = page.coat;
  if (page.tint > 0) {
    LG_ASSIGN(filter.tint, GreyTint(TintKind::kDip, 1 - page.tint, thickness_mm));
  }
  return LuminousTransmittance(filter, 1, thickness_mm);
}

std::string SheetJson(const CertifiedLens& lens, const PageOrder& page, const PageSheet& whole) {
  const LensSheet& sheet = whole.sheet;
  const double transmittance = whole.transmittance;
  Json certificate = Json::array();
  for (const Measurement& m : lens.certificate().measurements) {
    certificate.push_back({{"quantity", m.quantity},
                           {"unit", m.unit},
                           {"ordered", Number(m.ordered)},
                           {"measured", Number(m.measured)},
                           {"tolerance", Number(m.tolerance)},
                           {"numerical_error", Number(m.numerical_error)},
                           {"source", m.source},
                           {"passed", m.passed()}});
  }
  const Medium& medium = lens.lens().medium;
  const std::optional<int> category = FilterCategory(transmittance);
  const EyePrescription& made = lens.design().order.rx;
  Json worn = FormJson(whole.worn.power, page.order.rx);
  worn["prism_in"] = whole.worn.prism_in;
  worn["prism_up"] = whole.worn.prism_up;
  const Json out = {
      {"ok", true},
      {"index_d", medium.index_d},
      {"front_power_D", Pair(sheet.front_power_D)},
      {"back_power_D", Pair(sheet.back_power_D)},
      {"radius_front_mm", Pair(sheet.radius_front_mm)},
      {"radii_back_mm", Pair(sheet.radii_back_mm)},
      {"back_vertex_power_D", Pair(sheet.back_vertex_power_D)},
      {"front_vertex_power_D", Pair(sheet.front_vertex_power_D)},
      {"equivalent_power_D", Pair(sheet.equivalent_power_D)},
      {"paper_power_D", Pair(sheet.paper_power_D)},
      {"paper_power_error_D", Pair(sheet.paper_power_error_D)},
      {"cardinal", Json::array({Cardinal(sheet.cardinal_along), Cardinal(sheet.cardinal_across)})},
      {"center_thickness_mm", sheet.center_thickness_mm},
      {"edge_thickness_mm",
       Json::array({Number(sheet.edge_thickness_min_mm), Number(sheet.edge_thickness_max_mm)})},
      {"mass_g", Number(sheet.mass_g)},
      {"min_blank_mm", Number(lens.design().min_blank_mm)},
      {"luminous_transmittance", transmittance},
      {"filter_category", category ? Json(*category) : Json(nullptr)},
      {"pupil_mm", sheet.pupil_mm},
      {"shape_factor", Pair(sheet.shape_factor)},
      {"power_factor", Pair(sheet.power_factor)},
      {"spectacle_magnification", Pair(sheet.spectacle_magnification)},
      {"observer_magnification_thin", Number(sheet.observer_magnification_thin)},
      {"observer_magnification_paraxial", Number(sheet.observer_magnification_paraxial)},
      {"observer_magnification_exact", sheet.observer_magnification_exact
                                           ? Number(*sheet.observer_magnification_exact)
                                           : Json(nullptr)},
      {"made",
       {{"sphere", made.sphere.value()},
        {"cylinder", made.cylinder.value()},
        {"axis", made.axis.value()}}},
      {"target", FormJson(whole.target, page.order.rx)},
      {"worn", worn},
      {"certificate", certificate},
  };
  return out.dump();
}

std::string ErrorJson(const Error& error) {
  return Json({{"ok", false}, {"error", error.message}})
      .dump(-1, ' ', true, Json::error_handler_t::replace);
}

std::string PrescriptionJson(const FhirPrescription& prescription) {
  const Prescription& rx = prescription.rx;
  Json pd = nullptr, vertex = nullptr;
  if (prescription.has_pd) pd = {{"right", rx.pd_right_mm}, {"left", rx.pd_left_mm}};
  if (prescription.has_vertex) vertex = rx.vertex_distance_mm;
  return Json({{"ok", true},
               {"OD", EyeJson(rx.right)},
               {"OS", EyeJson(rx.left)},
               {"PD", pd},
               {"vertex_distance", vertex}})
      .dump();
}

std::string FhirJson(const std::string& resource) {
  return Json({{"ok", true}, {"fhir", resource}}).dump();
}

std::string MediaJson() {
  Json media = Json::array();
  for (const MediumEntry& entry : StandardMedia()) {
    media.push_back({{"name", entry.medium.name},
                     {"index_d", entry.medium.index_d},
                     {"abbe", entry.medium.abbe},
                     {"density_g_cm3", entry.medium.density_g_cm3},
                     {"min_center_mm", entry.min_center_mm},
                     {"min_edge_mm", entry.min_edge_mm}});
  }
  return media.dump();
}

}  // namespace lorgnette::page
