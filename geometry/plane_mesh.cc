// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane_mesh.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>

#include <algorithm>
#include <map>

namespace lorgnette {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Delaunay_mesh_vertex_base_2<Kernel>;
using Face = CGAL::Delaunay_mesh_face_base_2<Kernel>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel,
                                               CGAL::Triangulation_data_structure_2<Vertex, Face>>;
using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Triangulation>;

constexpr double kShapeBound = 0.125;  // B^2 >= 1/(4 sin^2 a): angles of 20.7 degrees and more

}  // namespace

Result<PlaneMesh> TriangulatePolygon(const Polygon2& polygon, double element_mm) {
  std::vector<Kernel::Point_2> corners;
  for (const Eigen::Vector2d& p : polygon) corners.emplace_back(p.x(), p.y());
  if (corners.size() < 3 || !CGAL::is_simple_2(corners.begin(), corners.end(), Kernel())) {
    return Failure("contour: got a curve that crosses itself, want a simple one");
  }
  if (SignedArea(polygon) <= 0) return Failure("contour: want it counter-clockwise");

  Triangulation cdt;
  std::vector<Triangulation::Vertex_handle> handles;
  for (const Kernel::Point_2& p : corners) handles.push_back(cdt.insert(p));
  for (std::size_t i = 0; i < handles.size(); ++i) {
    cdt.insert_constraint(handles[i], handles[(i + 1) % handles.size()]);
  }
  CGAL::refine_Delaunay_mesh_2(cdt, Criteria(kShapeBound, element_mm));

  PlaneMesh mesh;
  std::map<Triangulation::Vertex_handle, int> index;
  const auto index_of = [&](Triangulation::Vertex_handle v) {
    const auto [at, inserted] = index.emplace(v, int(mesh.points.size()));
    if (inserted) mesh.points.emplace_back(v->point().x(), v->point().y());
    return at->second;
  };
  std::map<int, int> next;  // along the boundary, the region on the left
  for (auto face = cdt.finite_faces_begin(); face != cdt.finite_faces_end(); ++face) {
    if (!face->is_in_domain()) continue;
    int corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = index_of(face->vertex(k));
    mesh.triangles.emplace_back(corner[0], corner[1], corner[2]);
    for (int k = 0; k < 3; ++k) {
      if (!face->neighbor(k)->is_in_domain() || cdt.is_infinite(face->neighbor(k))) {
        next[corner[(k + 1) % 3]] = corner[(k + 2) % 3];
      }
    }
  }
  // From each corner of the polygon to the next; points between them split the edge.
  const int start = index_of(handles[0]);
  int at = start, edge = 0;
  std::map<int, int> corner_of;
  for (std::size_t i = 0; i < handles.size(); ++i) corner_of[index_of(handles[i])] = int(i);
  do {
    BoundaryPoint point{at, edge, 0};
    if (const auto corner = corner_of.find(at); corner != corner_of.end()) {
      edge = point.edge = corner->second;
    } else {
      const Eigen::Vector2d& a = polygon[std::size_t(edge)];
      const Eigen::Vector2d along = polygon[(std::size_t(edge) + 1) % polygon.size()] - a;
      point.fraction =
          std::clamp((mesh.points[std::size_t(at)] - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    }
    mesh.boundary.push_back(point);
    const auto step = next.find(at);
    if (step == next.end() || mesh.boundary.size() > next.size()) {
      return Failure("contour: its triangulation has no single boundary");
    }
    at = step->second;
  } while (at != start);
  return mesh;
}

}  // namespace lorgnette
