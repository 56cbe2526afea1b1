// SPDX-License-Identifier: Apache-2.0
#include "page_api.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "optics/certify.h"
#include "optics/focimeter.h"
#include "optics/lens_sheet.h"
#include "optics/trace.h"
#include "optics/wear.h"
#include "page_json.h"
#include "page_slots.h"

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using lorgnette::Lens;
using lorgnette::LensTrace;
using lorgnette::Ray;
using lorgnette::RayStatus;
using lorgnette::page::kNaN;
using lorgnette::page::PageOrder;
using lorgnette::page::Slot;
using lorgnette::page::WornFrame;

std::array<std::optional<Slot>, kPageSlots>& Slots() {
  static std::array<std::optional<Slot>, kPageSlots> slots;
  return slots;
}

Vector2d Meridian(double degrees) {
  const double a = lorgnette::RadiansFromDegrees(degrees);
  return {-std::cos(a), std::sin(a)};
}

// The design of an order and what the eye meets through it, the lens made as it must be worn where
// that is asked for.
struct Made {
  lorgnette::LensDesign design;
  lorgnette::PowerVector target;
  lorgnette::WornPower worn;
};
lorgnette::Result<Made> Make(const PageOrder& page) {
  const lorgnette::LensOrder& order = page.order;
  if (page.compensate) {
    LG_ASSIGN(auto made, lorgnette::CompensateForWear(order, page.refraction_vertex_mm, page.wear));
    return Made{std::move(made.design), made.target, made.worn};
  }
  LG_ASSIGN(auto design, lorgnette::DesignLens(order));
  LG_ASSIGN(const auto worn, lorgnette::MeasureWorn(design.lens, order.eye, page.wear));
  const auto target = lorgnette::VertexCompensated(
      lorgnette::PowerVectorOf({order.rx.sphere, order.rx.cylinder, order.rx.axis}),
      page.refraction_vertex_mm - page.wear.vertex_distance_mm);
  return Made{std::move(design), target, worn};
}

lorgnette::Result<std::string> DesignInto(int slot, const std::string& order_json) {
  auto& place = Slots()[std::size_t(slot)];
  // The other eye's order changes more often than not.
  if (place && place->order_json == order_json) return place->sheet_json;
  LG_ASSIGN(const PageOrder page, lorgnette::page::ReadOrder(order_json));
  LG_ASSIGN(Made made, Make(page));
  LG_ASSIGN(auto certified, lorgnette::Certify(std::move(made.design)));
  lorgnette::page::PageSheet sheet;
  sheet.sheet = MakeLensSheet(certified.design(), page.request);
  LG_ASSIGN(sheet.transmittance,
            lorgnette::page::Transmittance(page, certified.lens().center_thickness_mm));
  sheet.target = made.target;
  sheet.worn = made.worn;
  std::string json = lorgnette::page::SheetJson(certified, page, sheet);
  place.emplace(Slot{order_json, page, std::move(certified), made.target, json});
  return json;
}

}  // namespace

const Slot* lorgnette::page::SlotAt(int slot) {
  if (slot < 0 || slot >= kPageSlots || !Slots()[std::size_t(slot)]) return nullptr;
  return &*Slots()[std::size_t(slot)];
}

const char* lg_design(int slot, const char* order_json) {
  static std::string out;
  if (slot < 0 || slot >= kPageSlots) {
    out = R"({"ok":false,"error":"slot: want 0..4"})";
    return out.c_str();
  }
  auto result = DesignInto(slot, order_json);
  out = result ? *std::move(result) : lorgnette::page::ErrorJson(result.error());
  return out.c_str();
}

const char* lg_media() {
  static std::string out;
  out = lorgnette::page::MediaJson();
  return out.c_str();
}

const char* lg_read_prescription(const char* text, const char* name) {
  static std::string out;
  lorgnette::Result<lorgnette::FhirPrescription> result;
  if (lorgnette::LooksLikeFhir(text)) {
    result = lorgnette::ParseFhir(text, name);
  } else {
    result = lorgnette::ParsePrescription(text, name).map([](lorgnette::Prescription rx) {
      return lorgnette::FhirPrescription{std::move(rx), true, true};
    });
  }
  out = result ? lorgnette::page::PrescriptionJson(*result)
               : lorgnette::page::ErrorJson(result.error());
  return out.c_str();
}

const char* lg_write_fhir(const char* text, const char* date) {
  static std::string out;
  const auto rx = lorgnette::ParsePrescription(text, "order");
  lorgnette::FhirHeader header;
  header.created = header.date_written = date;
  header.patient = "Patient/unknown";
  header.prescriber = "Practitioner/unknown";
  out = rx ? lorgnette::page::FhirJson(lorgnette::WriteFhir(*rx, header))
           : lorgnette::page::ErrorJson(rx.error());
  return out.c_str();
}

const double* lg_surfaces(int slot, const double* points, int n) {
  static std::vector<double> out;
  out.assign(2 * std::size_t(n), kNaN);
  const Lens* lens = lorgnette::page::LensIn(slot);
  for (int i = 0; lens && i < n; ++i) {
    const double x = points[2 * i], y = points[2 * i + 1];
    double* z = out.data() + 2 * i;
    if (const auto front = lens->front.Jet(x, y)) z[0] = front->z;
    if (const auto back = lorgnette::IntersectBack(*lens, {{x, y, 0}, {0, 0, 1}})) {
      z[1] = back->point.z();
    }
  }
  return out.data();
}

const double* lg_fan(int slot_number, double meridian_deg, double half_mm, int n, double field_deg,
                     double object_mm, double object_height_mm) {
  constexpr int kRow = 9;
  static std::vector<double> out;
  out.assign(kRow * std::size_t(n), 0);
  for (int i = 0; i < n; ++i) out[std::size_t(kRow * i)] = double(RayStatus::kMissesSurface);
  const Slot* slot = lorgnette::page::SlotAt(slot_number);
  if (!slot) return out.data();
  const Lens& lens = slot->lens();
  const WornFrame frame(*slot);
  const Vector2d u = Meridian(meridian_deg);
  const double tangent = std::tan(lorgnette::RadiansFromDegrees(field_deg));
  for (int i = 0; i < n; ++i) {
    double* row = out.data() + kRow * i;
    const double h = n == 1 ? 0 : half_mm * (2.0 * i / (n - 1) - 1);
    // Starts well before the lens, aimed at height h of the front surface.
    const auto jet = lens.front.Jet(h * u.x(), h * u.y());
    if (!jet) continue;
    const Vector3d to = frame.FromLens(Vector3d(h * u.x(), h * u.y(), jet->z));
    const double far_mm = object_mm > 0 ? object_mm : 60;
    Vector3d from = to - (far_mm + to.z()) * Vector3d(tangent * u.x(), tangent * u.y(), 1);
    if (object_mm > 0) from << object_height_mm * u, -far_mm;
    const LensTrace trace =
        lorgnette::TraceThrough(lens, frame.ToLens(Ray{from, (to - from).normalized()}));
    row[0] = double(trace.status);
    row[1] = from.head<2>().dot(u);
    row[2] = from.z();
    row[3] = to.head<2>().dot(u);
    row[4] = to.z();
    if (trace.status != RayStatus::kOk) continue;
    const Ray exit = frame.FromLens(trace.exit);
    row[5] = exit.origin.head<2>().dot(u);
    row[6] = exit.origin.z();
    row[7] = exit.direction.head<2>().dot(u);
    row[8] = exit.direction.z();
  }
  return out.data();
}

const double* lg_worn(int slot_number) {
  static std::array<double, 12> out;
  out = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  const Slot* slot = lorgnette::page::SlotAt(slot_number);
  if (!slot) return out.data();
  const WornFrame frame(*slot);
  const Vector3d origin = frame.FromLens(Vector3d(0, 0, 0));
  for (int column = 0; column < 3; ++column) {
    const Vector3d axis = frame.DirectionFromLens(Vector3d::Unit(column));
    for (int row = 0; row < 3; ++row) out[std::size_t(3 * row + column)] = axis[row];
    out[std::size_t(9 + column)] = origin[column];
  }
  return out.data();
}

const double* lg_focimeter(int slot, double x_mm, double y_mm, int turned) {
  static std::array<double, 6> out;
  out.fill(kNaN);
  const Lens* lens = lorgnette::page::LensIn(slot);
  if (!lens) return out.data();
  const auto read = turned ? lorgnette::ReadFrontVertexPower : lorgnette::ReadBackVertexPower;
  const auto reading = read(*lens, lens->medium.index_d, Vector2d(x_mm, y_mm), {});
  if (!reading) return out.data();
  const auto power = lorgnette::PowerVectorOfLensFrame(reading->power_D);
  out = {power.mean,         power.j0,           power.j45,
         reading->prism.x(), reading->prism.y(), reading->residual_D};
  return out.data();
}
