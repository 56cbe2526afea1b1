// SPDX-License-Identifier: Apache-2.0
#include "geometry/mesh_check.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <map>
#include <numeric>
#include <unordered_map>

#include "geometry/sweep.h"

namespace lorgnette {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

int CountSelfIntersections(const TriangleMesh& mesh) {
  std::vector<Kernel::Point_3> points;
  for (const Eigen::Vector3d& p : mesh.positions) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> faces;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    faces.push_back({std::size_t(t[0]), std::size_t(t[1]), std::size_t(t[2])});
  }
  namespace pmp = CGAL::Polygon_mesh_processing;
  if (!pmp::is_polygon_soup_a_polygon_mesh(faces)) pmp::orient_polygon_soup(points, faces);
  using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
  Surface surface;
  pmp::polygon_soup_to_polygon_mesh(points, faces, surface);
  std::vector<std::pair<Surface::Face_index, Surface::Face_index>> pairs;
  pmp::self_intersections(surface, std::back_inserter(pairs));
  return int(pairs.size());
}

}  // namespace

TriangleMesh MergeEqualPositions(const TriangleMesh& mesh) {
  TriangleMesh merged;
  std::map<std::array<double, 3>, int> index;
  std::vector<int> moved(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Eigen::Vector3d& p = mesh.positions[i];
    const auto [at, inserted] =
        index.emplace(std::array{p.x(), p.y(), p.z()}, int(merged.positions.size()));
    if (inserted) merged.positions.push_back(p);
    moved[i] = at->second;
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    merged.triangles.emplace_back(moved[std::size_t(t[0])], moved[std::size_t(t[1])],
                                  moved[std::size_t(t[2])]);
  }
  return merged;
}

MeshReport CheckMesh(const TriangleMesh& mesh, bool find_self_intersections) {
  TriangleMesh merged = MergeEqualPositions(mesh);
  MeshReport report;
  report.degenerate_triangles = int(std::erase_if(merged.triangles, [](const Eigen::Vector3i& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  }));
  report.vertices = int(merged.positions.size());
  report.triangles = int(merged.triangles.size());

  // Each edge by its vertices in ascending order: how often walked up, how often down.
  std::unordered_map<std::uint64_t, std::pair<int, int>> edges;
  std::vector<int> parent(merged.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[std::size_t(v)] != v) {
      v = parent[std::size_t(v)] = parent[std::size_t(parent[std::size_t(v)])];
    }
    return v;
  };
  for (const Eigen::Vector3i& t : merged.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      auto& [up, down] =
          edges[(std::uint64_t(std::min(a, b)) << 32) | std::uint64_t(std::max(a, b))];
      ++(a < b ? up : down);
      parent[std::size_t(root(a))] = root(b);
    }
  }
  for (const auto& [key, walked] : edges) {
    const auto [up, down] = walked;
    if (up + down == 1) {
      ++report.boundary_edges;
    } else if (up != 1 || down != 1) {
      ++report.non_manifold_edges;
    }
  }
  std::map<int, double> volumes;  // one a component
  for (const Eigen::Vector3i& t : merged.triangles) {
    const auto at = [&](int k) { return merged.positions[std::size_t(t[k])]; };
    volumes[root(t[0])] += at(0).dot(at(1).cross(at(2))) / 6;
  }
  report.components = int(volumes.size());
  for (const auto& [vertex, volume] : volumes) {
    report.least_part_mm3 =
        vertex == volumes.begin()->first ? volume : std::min(report.least_part_mm3, volume);
  }
  report.volume_mm3 = SignedVolume(merged);
  if (find_self_intersections) report.self_intersections = CountSelfIntersections(merged);
  return report;
}

}  // namespace lorgnette
