// SPDX-License-Identifier: Apache-2.0
#include "geometry/lens_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "base/units.h"
#include "geometry/closed_curve.h"
#include "geometry/plane_mesh.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

constexpr double kLeastShoulder_mm = 0.02;  // keeps the wall's strips from vanishing

constexpr double kLeastBevel_mm = 0.05;   // lower than this, and the edge is flat
constexpr double kGrooveShoulder = 0.25;  // of the edge, left on either side of a groove

// One closed line around the edge: position and the wall's direction away from the lens there.
using EdgeRing = std::vector<Eigen::Vector3d>;

// A strip between two rings with its own vertices and the normals of the ruled surface.
void AppendStrip(TriangleMesh& mesh, const EdgeRing& front, const EdgeRing& back) {
  const int n = int(front.size());
  const int base = int(mesh.positions.size());
  for (std::size_t i = 0; i < front.size(); ++i) {
    const std::size_t before = (i + front.size() - 1) % front.size(),
                      after = (i + 1) % front.size();
    // Counter-clockwise in (x, y), front to back is +z: along x across points outward.
    const Eigen::Vector3d across = back[i] - front[i];
    const Eigen::Vector3d normal = (front[after] - front[before]).cross(across).normalized();
    mesh.positions.push_back(front[i]);
    mesh.positions.push_back(back[i]);
    mesh.normals.push_back(normal);
    mesh.normals.push_back(normal);
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    const int a = base + 2 * i, b = base + 2 * j;
    mesh.triangles.emplace_back(a, b, b + 1);
    mesh.triangles.emplace_back(a, b + 1, a + 1);
  }
}

}  // namespace

std::optional<SurfaceHit> FrontHit(const Lens& lens, const Eigen::Vector2d& p) {
  return lens.front.Intersect({{p.x(), p.y(), 0}, {0, 0, 1}});
}
std::optional<SurfaceHit> BackHit(const Lens& lens, const Eigen::Vector2d& p) {
  return IntersectBack(lens, {{p.x(), p.y(), 0}, {0, 0, 1}});
}

Result<TriangleMesh> BuildLensMesh(const Lens& lens, const std::vector<Eigen::Vector2d>& contour_mm,
                                   const LensMeshOptions& options) {
  const Polygon2 outer = Resample(contour_mm, options.edge_points);
  const bool grooved = options.groove_width_mm > 0;
  const bool given = options.apex_z_mm.size() == contour_mm.size();
  const std::vector<double> apex_z =
      given ? ResampleAlong(contour_mm, options.apex_z_mm, options.edge_points)
            : std::vector<double>();
  // Around a corner tighter than the bevel is high (the groove deep) its foot would cross itself:
  // it is made lower there, all around, until it does not.
  double height = grooved ? options.groove_depth_mm : options.bevel_height_mm;
  Polygon2 inner = outer;
  Result<PlaneMesh> plane = PlaneMesh{};
  for (; height > kLeastBevel_mm; height /= 2) {
    inner = Offset(outer, -height);
    plane = TriangulatePolygon(inner, options.element_mm);
    if (plane) break;
  }
  const bool flat = height <= kLeastBevel_mm;
  if (flat || grooved) plane = TriangulatePolygon(outer, options.element_mm);
  if (!plane) return tl::unexpected(plane.error());
  const Polygon2& bottom = inner;

  TriangleMesh mesh;
  std::vector<Eigen::Vector3d> front_points, back_points;
  for (const Eigen::Vector2d& p : plane->points) {
    const auto front = FrontHit(lens, p), back = BackHit(lens, p);
    if (!front || !back) return Failure("cut: a surface ends inside the contour");
    front_points.push_back(front->point);
    back_points.push_back(back->point);
    mesh.positions.push_back(front->point);
    mesh.normals.push_back(-front->normal);
  }
  const int n = int(plane->points.size());
  for (const Eigen::Vector2d& p : plane->points) {
    const auto back = BackHit(lens, p);
    mesh.positions.push_back(back->point);
    mesh.normals.push_back(back->normal);
  }
  for (const Eigen::Vector3i& t : plane->triangles) {
    mesh.triangles.emplace_back(t[0], t[2], t[1]);  // the front looks to -z
    mesh.triangles.emplace_back(n + t[0], n + t[1], n + t[2]);
  }

  // Front to back: surface, start of bevel or groove, apex (twice for a groove's bottom), its end,
  // surface.
  EdgeRing front, before, apex, apex_end, after, back;
  const double half = grooved ? options.groove_width_mm / 2
                              : height * std::tan(RadiansFromDegrees(options.bevel_angle_deg) / 2);
  for (const BoundaryPoint& b : plane->boundary) {
    const Eigen::Vector3d &f = front_points[std::size_t(b.index)],
                          &k = back_points[std::size_t(b.index)];
    const std::size_t i = std::size_t(b.edge), j = (i + 1) % outer.size();
    const auto along = [&](const auto& of) -> std::decay_t<decltype(of[0])> {
      return (1 - b.fraction) * of[i] + b.fraction * of[j];
    };
    const double least = f.z() + 2 * kLeastShoulder_mm, most = k.z() - 2 * kLeastShoulder_mm;
    const double z =
        given && least < most ? std::clamp(along(apex_z), least, most) : (f.z() + k.z()) / 2;
    const Eigen::Vector2d out = along(grooved ? bottom : outer);
    const double shoulder = grooved ? kGrooveShoulder * (k.z() - f.z()) : kLeastShoulder_mm;
    const double z0 = std::max(z - half, f.z() + shoulder);
    const double z1 = std::min(z + half, k.z() - shoulder);
    front.push_back(f);
    back.push_back(k);
    before.emplace_back(f.x(), f.y(), z0);
    after.emplace_back(k.x(), k.y(), z1);
    apex.emplace_back(out.x(), out.y(), grooved ? z0 : z);
    apex_end.emplace_back(out.x(), out.y(), z1);
  }
  if (!flat) {
    AppendStrip(mesh, front, before);
    AppendStrip(mesh, before, apex);
    if (grooved) AppendStrip(mesh, apex, apex_end);
    AppendStrip(mesh, grooved ? apex_end : apex, after);
    AppendStrip(mesh, after, back);
  } else {
    AppendStrip(mesh, front, back);
  }
  return mesh;
}

}  // namespace lorgnette
