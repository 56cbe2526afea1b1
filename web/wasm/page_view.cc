// SPDX-License-Identifier: Apache-2.0
// What a camera sees through a worn lens: the face behind it, the edge's rings, and what the two
// surfaces mirror.
#include <cmath>
#include <limits>
#include <vector>

#include "optics/trace.h"
#include "page_api.h"
#include "page_face.h"
#include "page_light.h"
#include "page_slots.h"

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using lorgnette::Lens;
using lorgnette::LensTrace;
using lorgnette::Ray;
using lorgnette::RayStatus;
using lorgnette::page::Mirror;
using lorgnette::page::Slot;
using lorgnette::page::WornFrame;

// From the irises to the wall behind the head.
constexpr double kBehind_mm = 300;

std::vector<float>& Rings() {
  static std::vector<float> rings;
  return rings;
}
std::vector<float>& Mirrored() {
  static std::vector<float> mirrored;
  return mirrored;
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

// Share that a coated surface throws back into the glass.
double Inside(const Mirror& mirror, double cos_inside, double index) {
  const double outside = lorgnette::page::CosineOutside(std::abs(cos_inside), index);
  return outside < 0 ? 1 : mirror.Luminous(outside);
}

// What is left of a camera's ray where, thrown back and forth between the surfaces, it first
// strikes the wall of the edge; 0 when it does not within kRingBounces.
double RingShare(const Slot& slot, const Mirror& mirror, const LensTrace& trace,
                 const Vector3d& incident) {
  constexpr int kRingBounces = 3;
  const Lens& lens = slot.lens();
  const double n = lens.medium.index_d;
  double share = 1 - mirror.Luminous(std::abs(incident.dot(trace.first.normal)));
  Ray ray{trace.second.point, trace.inside_direction};
  Vector3d normal = trace.second.normal;
  for (int bounce = 0; bounce < kRingBounces; ++bounce) {
    share *= Inside(mirror, ray.direction.dot(normal), n);
    ray.direction = lorgnette::Reflect(ray.direction, normal);
    // Odd bounces go to the front, even ones to the back again.
    const auto hit =
        bounce % 2 == 0 ? lens.front.Intersect(ray) : lorgnette::IntersectBack(lens, ray);
    if (!hit || !WithinCut(slot.page.order, hit->point.head<2>())) return share;
    ray.origin = hit->point;
    normal = hit->normal;
  }
  return 0;
}

// One mirrored view: where it looks (x, y of a unit vector toward the camera's side) and the share
// of that light in linear red, green and blue.
void Write(float* out, const Vector3d& direction, const Vector3d& share) {
  if (!(direction.z() < 0)) return;
  out[0] = float(direction.x());
  out[1] = float(direction.y());
  for (int c = 0; c < 3; ++c) out[2 + c] = float(share[c]);
}

// The mirror images in the front surface and, through it, in the back one.
void WriteMirrored(const Slot& slot, const WornFrame& frame, const Mirror& mirror,
                   const LensTrace& trace, const Vector3d& incident, float* out) {
  const Lens& lens = slot.lens();
  const double n = lens.medium.index_d, glass = 1 - slot.page.tint;
  const Vector3d first = mirror.Rgb(std::abs(incident.dot(trace.first.normal)));
  Write(out, frame.DirectionFromLens(lorgnette::Reflect(incident, trace.first.normal)), first);
  const double outside =
      lorgnette::page::CosineOutside(std::abs(trace.inside_direction.dot(trace.second.normal)), n);
  const Ray back{trace.second.point,
                 lorgnette::Reflect(trace.inside_direction, trace.second.normal)};
  const auto hit = lens.front.Intersect(back);
  if (!hit) return;
  const auto away = lorgnette::Refract(back.direction, hit->normal, n);
  if (!away) return;
  const Vector3d again = mirror.Rgb(std::abs(away->dot(hit->normal)));
  const Vector3d one = Vector3d::Ones();
  const Vector3d second = outside < 0 ? one : mirror.Rgb(outside);
  Write(out + 5, frame.DirectionFromLens(*away),
        glass * glass * (one - first).cwiseProduct(second).cwiseProduct(one - again));
}

}  // namespace

const float* lg_rings() { return Rings().data(); }
const float* lg_mirrored() { return Mirrored().data(); }

const float* lg_view(int slot_number, const PageView* view, int w, int h) {
  static std::vector<float> out;
  const std::size_t pixels = std::size_t(w) * std::size_t(h);
  out.assign(4 * pixels, 0);
  Rings().assign(view->rings != 0 ? pixels : 0, 0);
  Mirrored().assign(view->mirrored != 0 ? kMirroredRow * pixels : 0, 0);
  for (std::size_t k = 0; k < pixels; ++k) out[4 * k] = float(RayStatus::kMissesSurface);
  const Slot* slot = lorgnette::page::SlotAt(slot_number);
  if (!slot) return out.data();

  const Lens& lens = slot->lens();
  const double n = lens.medium.index_d, glass = 1 - slot->page.tint;
  const double iris_z = lens.center_thickness_mm + view->depth_mm;
  const WornFrame frame(*slot);
  const Mirror& mirror = Mirror::Of(slot->page.coat, n);
  const Vector3d camera(view->cx, view->cy, -view->camera_mm);
  float* pixel = out.data();
  for (std::size_t k = 0; k < pixels; ++k, pixel += 4) {
    const auto i = double(k % std::size_t(w)), j = double(k / std::size_t(w));
    const double x = view->x0 + (view->x1 - view->x0) * (i + 0.5) / w;
    const double y = view->y1 + (view->y0 - view->y1) * (j + 0.5) / h;
    const Ray ray = frame.ToLens(Ray{camera, (Vector3d(x, y, 0) - camera).normalized()});
    const LensTrace trace = lorgnette::TraceThrough(lens, ray);
    pixel[0] = float(trace.status);
    if (trace.status == RayStatus::kMissesSurface) continue;
    if (view->mirrored != 0) {
      WriteMirrored(*slot, frame, mirror, trace, ray.direction,
                    Mirrored().data() + kMirroredRow * k);
    }
    if (view->rings != 0) Rings()[k] = float(RingShare(*slot, mirror, trace, ray.direction));
    if (trace.status != RayStatus::kOk) continue;
    const Ray exit = frame.FromLens(trace.exit);
    auto met = lorgnette::page::MeetFace(exit, iris_z, view->face_x_mm);
    // A ray that passes the head goes on to the wall: so the outline of the face breaks at the rim.
    if (!met && exit.direction.z() > 0) {
      met = exit.origin +
            (iris_z + kBehind_mm - exit.origin.z()) / exit.direction.z() * exit.direction;
    }
    if (!met) {
      pixel[0] = float(RayStatus::kMissesSurface);
      continue;
    }
    // Where the camera sees that point without the lens.
    const double scale = view->camera_mm / (view->camera_mm + met->z());
    pixel[1] = float(camera.x() + (met->x() - camera.x()) * scale + view->face_x_mm);
    pixel[2] = float(camera.y() + (met->y() - camera.y()) * scale);
    pixel[3] = float(
        lorgnette::page::Passed(mirror, std::abs(ray.direction.dot(trace.first.normal)),
                                std::abs(trace.exit.direction.dot(trace.second.normal)), glass));
  }
  return out.data();
}
