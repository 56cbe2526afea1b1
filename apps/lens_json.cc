// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "optics/media.h"
#include "validation/backing.h"

namespace lorgnette {
namespace {

using Json = nlohmann::ordered_json;

Json Pair(const MeridianPair& pair) { return {JsonNumber(pair.along), JsonNumber(pair.across)}; }

Json CardinalJson(const std::optional<CardinalPoints>& points) {
  if (!points) return nullptr;
  return {{"front_focal_mm", JsonNumber(points->front_focal_mm)},
          {"back_focal_mm", JsonNumber(points->back_focal_mm)},
          {"front_principal_mm", JsonNumber(points->front_principal_mm)},
          {"back_principal_mm", JsonNumber(points->back_principal_mm)}};
}

Json OrderJson(const LensOrder& order) {
  const EyePrescription& rx = order.rx;
  Json json = {{"sphere_D", rx.sphere.value()}, {"cylinder_D", rx.cylinder.value()}};
  json["axis_deg"] = rx.cylinder.value() != 0 ? Json(rx.axis.value()) : Json(nullptr);
  json["add_D"] = rx.add.value();
  json["prism_in"] = rx.prism_in.value();
  json["prism_up"] = rx.prism_up.value();
  json["medium"] = order.medium.name;
  json["index"] = order.medium.index_d;
  json["index_e"] = IndexAt(order.medium, kLineE_nm);
  json["abbe"] = order.medium.abbe;
  json["density_g_cm3"] = order.medium.density_g_cm3;
  json["base_curve_D"] = order.base_curve ? Json(order.base_curve->value()) : Json(nullptr);
  json["vertex_distance_mm"] = order.vertex_distance_mm;
  return json;
}

}  // namespace

Json JsonNumber(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json LensJson(const LensDesign& design, const LensSheet& sheet) {
  Json json;
  json["eye"] = design.order.eye == Eye::kRight ? "right" : "left";
  json["order"] = OrderJson(design.order);
  json["back_vertex_power_D"] = JsonNumber(sheet.back_vertex_power_D.along);
  json["front_vertex_power_D"] = JsonNumber(sheet.front_vertex_power_D.along);
  json["equivalent_power_D"] = JsonNumber(sheet.equivalent_power_D.along);
  json["front_power_D"] = JsonNumber(sheet.front_power_D.along);
  json["back_power_D"] = JsonNumber(sheet.back_power_D.along);
  json["radius_front_mm"] = JsonNumber(sheet.radius_front_mm.along);
  json["radii_front_mm"] = Pair(sheet.radius_front_mm);
  json["radii_back_mm"] = Pair(sheet.radii_back_mm);
  json["center_thickness_mm"] = sheet.center_thickness_mm;
  json["edge_thickness_mm"] = JsonNumber(sheet.edge_thickness_max_mm);
  json["edge_thickness_min_mm"] = JsonNumber(sheet.edge_thickness_min_mm);
  json["mass_g"] = JsonNumber(sheet.mass_g);
  json["min_blank_mm"] = JsonNumber(sheet.min_blank_mm);
  json["spectacle_magnification"] = JsonNumber(sheet.spectacle_magnification.along);
  // Along the cylinder axis, and across it; equal for a sphere.
  json["meridians"] = {{"back_vertex_power_D", Pair(sheet.back_vertex_power_D)},
                       {"front_vertex_power_D", Pair(sheet.front_vertex_power_D)},
                       {"equivalent_power_D", Pair(sheet.equivalent_power_D)},
                       {"front_power_D", Pair(sheet.front_power_D)},
                       {"back_power_D", Pair(sheet.back_power_D)},
                       {"paper_power_D", Pair(sheet.paper_power_D)},
                       {"paper_power_error_D", Pair(sheet.paper_power_error_D)},
                       {"shape_factor", Pair(sheet.shape_factor)},
                       {"power_factor", Pair(sheet.power_factor)},
                       {"spectacle_magnification", Pair(sheet.spectacle_magnification)}};
  json["cardinal_points"] = {CardinalJson(sheet.cardinal_along),
                             CardinalJson(sheet.cardinal_across)};
  return json;
}

Json CertificateJson(const Certificate& certificate) {
  Json rows = Json::array();
  for (const Measurement& m : certificate.measurements) {
    rows.push_back({{"quantity", m.quantity},
                    {"unit", m.unit},
                    {"predicted", JsonNumber(m.ordered)},
                    {"measured", JsonNumber(m.measured)},
                    {"difference", JsonNumber(m.measured - m.ordered)},
                    {"tolerance", JsonNumber(m.tolerance)},
                    {"numerical_error", JsonNumber(m.numerical_error)},
                    {"passed", m.passed()},
                    {"source", m.source},
                    {"backed_by", validation::CasesBacking(m.quantity)}});
  }
  return rows;
}

}  // namespace lorgnette
