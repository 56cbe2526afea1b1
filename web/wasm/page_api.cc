// SPDX-License-Identifier: Apache-2.0
#include "page_api.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "optics/certify.h"
#include "optics/lens_sheet.h"
#include "optics/trace.h"
#include "page_json.h"
#include "page_slots.h"

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using lorgnette::CertifiedLens;
using lorgnette::Lens;
using lorgnette::LensTrace;
using lorgnette::Ray;
using lorgnette::RayStatus;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::array<std::optional<CertifiedLens>, kPageSlots>& Slots() {
  static std::array<std::optional<CertifiedLens>, kPageSlots> slots;
  return slots;
}

Vector2d Meridian(double degrees) {
  const double a = lorgnette::RadiansFromDegrees(degrees);
  return {-std::cos(a), std::sin(a)};
}

lorgnette::Result<std::string> DesignInto(int slot, const std::string& order_json) {
  LG_ASSIGN(const auto page, lorgnette::page::ReadOrder(order_json));
  LG_ASSIGN(auto design, lorgnette::DesignLens(page.order));
  LG_ASSIGN(auto certified, lorgnette::Certify(std::move(design)));
  const auto sheet = lorgnette::MakeLensSheet(certified.design(), page.request);
  LG_ASSIGN(const double light,
            lorgnette::page::Transmittance(page, certified.lens().center_thickness_mm));
  std::string json = lorgnette::page::SheetJson(certified, sheet, light);
  Slots()[std::size_t(slot)].emplace(std::move(certified));
  return json;
}

double Transmittance(const LensTrace& trace, const Vector3d& incident, double index) {
  const double first = std::abs(incident.dot(trace.first.normal));
  const double second = std::abs(trace.inside_direction.dot(trace.second.normal));
  return (1 - lorgnette::FresnelReflectance(first, 1 / index)) *
         (1 - lorgnette::FresnelReflectance(second, index));
}

// Where a ray behind the lens meets the face; the face recedes, so a few Newton-like steps settle.
Vector2d FacePoint(const Ray& ray, double back_vertex_z, const PageView& view) {
  double steps = 0;
  Vector3d p = ray.origin;
  for (int i = 0; i < 6; ++i) {
    const double beyond = std::max(0.0, std::abs(p.x() + view.face_x_mm) - view.flat_mm);
    const double z = back_vertex_z + view.depth_mm + view.curve * beyond * beyond / 100;
    steps = (z - ray.origin.z()) / ray.direction.z();
    p = ray.origin + steps * ray.direction;
  }
  return p.head<2>();
}

std::vector<float>& Rings() {
  static std::vector<float> rings;
  return rings;
}

// Within the cut outline, or the round lens where there is none.
bool WithinCut(const lorgnette::LensOrder& order, const Vector2d& p) {
  const auto& contour = order.contour_mm;
  if (contour.empty()) return p.norm() < order.diameter_mm / 2;
  bool inside = false;
  for (std::size_t i = 0, j = contour.size() - 1; i < contour.size(); j = i++) {
    const Vector2d &a = contour[i], &b = contour[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) {
      inside = !inside;
    }
  }
  return inside;
}

// What is left of a camera's ray where, thrown back and forth between the surfaces, it first
// strikes the wall of the edge; 0 when it does not within kRingBounces.
double RingShare(int slot, const LensTrace& trace, const Vector3d& incident) {
  constexpr int kRingBounces = 3;
  const CertifiedLens& certified = *Slots()[std::size_t(slot)];
  const Lens& lens = certified.lens();
  const double n = lens.medium.index_d;
  double share = 1 - lorgnette::FresnelReflectance(incident.dot(trace.first.normal), 1 / n);
  Ray ray{trace.second.point, trace.inside_direction};
  Vector3d normal = trace.second.normal;
  for (int bounce = 0; bounce < kRingBounces; ++bounce) {
    share *= lorgnette::FresnelReflectance(ray.direction.dot(normal), n);
    ray.direction = lorgnette::Reflect(ray.direction, normal);
    // Odd bounces go to the front, even ones to the back again.
    const auto hit =
        bounce % 2 == 0 ? lens.front.Intersect(ray) : lorgnette::IntersectBack(lens, ray);
    if (!hit || !WithinCut(certified.design().order, hit->point.head<2>())) return share;
    ray.origin = hit->point;
    normal = hit->normal;
  }
  return 0;
}

}  // namespace

const Lens* lorgnette::page::LensIn(int slot) {
  if (slot < 0 || slot >= kPageSlots || !Slots()[std::size_t(slot)]) return nullptr;
  return &Slots()[std::size_t(slot)]->lens();
}

const char* lg_design(int slot, const char* order_json) {
  static std::string out;
  if (slot < 0 || slot >= kPageSlots) {
    out = R"({"ok":false,"error":"slot: want 0..3"})";
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

const double* lg_fan(int slot, double meridian_deg, double half_mm, int n, double field_deg,
                     double object_mm, double object_height_mm) {
  constexpr int kRow = 9;
  static std::vector<double> out;
  out.assign(kRow * std::size_t(n), 0);
  const Lens* lens = lorgnette::page::LensIn(slot);
  const Vector2d u = Meridian(meridian_deg);
  const double tangent = std::tan(lorgnette::RadiansFromDegrees(field_deg));
  for (int i = 0; i < n; ++i) {
    double* row = out.data() + kRow * i;
    row[0] = double(RayStatus::kMissesSurface);
    if (!lens) continue;
    const double h = n == 1 ? 0 : half_mm * (2.0 * i / (n - 1) - 1);
    // Starts well before the lens, aimed at height h of the front surface.
    const auto jet = lens->front.Jet(h * u.x(), h * u.y());
    if (!jet) continue;
    const double far_mm = object_mm > 0 ? object_mm : 60;
    const double start = object_mm > 0 ? object_height_mm : h - tangent * (far_mm + jet->z);
    const Vector3d from(start * u.x(), start * u.y(), -far_mm), to(h * u.x(), h * u.y(), jet->z);
    const Ray ray{from, (to - from).normalized()};
    const LensTrace trace = lorgnette::TraceThrough(*lens, ray);
    row[0] = double(trace.status);
    row[1] = start;
    row[2] = -far_mm;
    row[3] = h;
    row[4] = jet->z;
    if (trace.status != RayStatus::kOk) continue;
    row[5] = trace.exit.origin.head<2>().dot(u);
    row[6] = trace.exit.origin.z();
    row[7] = trace.exit.direction.head<2>().dot(u);
    row[8] = trace.exit.direction.z();
  }
  return out.data();
}

const float* lg_rings() { return Rings().data(); }

const float* lg_view(int slot, const PageView* view, int w, int h) {
  static std::vector<float> out;
  out.assign(4 * std::size_t(w) * std::size_t(h), 0);
  const Lens* lens = lorgnette::page::LensIn(slot);
  const Vector3d eye(view->cx, view->cy, -view->camera_mm);
  float* pixel = out.data();
  Rings().assign(std::size_t(w) * std::size_t(h), 0);
  float* ring = Rings().data();
  for (int j = 0; j < h; ++j) {
    for (int i = 0; i < w; ++i, pixel += 4, ++ring) {
      pixel[0] = float(RayStatus::kMissesSurface);
      if (!lens) continue;
      const double x = view->x0 + (view->x1 - view->x0) * (i + 0.5) / w;
      const double y = view->y1 + (view->y0 - view->y1) * (j + 0.5) / h;
      const Ray ray{eye, (Vector3d(x, y, 0) - eye).normalized()};
      const LensTrace trace = lorgnette::TraceThrough(*lens, ray);
      pixel[0] = float(trace.status);
      if (trace.status != RayStatus::kOk || !(trace.exit.direction.z() > 0)) continue;
      const Vector2d face = FacePoint(trace.exit, lens->center_thickness_mm, *view);
      pixel[1] = float(face.x());
      pixel[2] = float(face.y());
      if (view->rings != 0) *ring = float(RingShare(slot, trace, ray.direction));
      pixel[3] = float(Transmittance(trace, ray.direction, lens->medium.index_d));
    }
  }
  return out.data();
}
