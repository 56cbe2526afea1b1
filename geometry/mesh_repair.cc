// SPDX-License-Identifier: Apache-2.0
#include "geometry/mesh_repair.h"

// Every triangulation of a hole is weighed, not only those among Delaunay's: the best one, quick
// enough for so few edges, and without the two further triangulators that CGAL would bring (a third
// of what its joined source took to compile).
#define CGAL_HOLE_FILLING_DO_NOT_USE_DT3
#define CGAL_HOLE_FILLING_DO_NOT_USE_CDT2
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>
#include <set>
#include <unordered_map>

#include "geometry/mesh_check.h"
#include "geometry/sweep.h"

namespace lorgnette {
namespace {

constexpr double kFlatArea_mm2 = 1e-9;
constexpr std::size_t kMostHoleEdges = 300;

// Number of the position of each vertex: vertices at one position share it.
std::vector<int> PositionNumbers(const TriangleMesh& mesh) {
  std::map<std::array<double, 3>, int> known;
  std::vector<int> numbers;
  for (const Eigen::Vector3d& p : mesh.positions) {
    numbers.push_back(
        known.emplace(std::array{p.x(), p.y(), p.z()}, int(known.size())).first->second);
  }
  return numbers;
}

std::uint64_t EdgeKey(int a, int b) {
  return (std::uint64_t(std::uint32_t(std::min(a, b))) << 32) | std::uint32_t(std::max(a, b));
}

int DropBadTriangles(TriangleMesh& mesh, const std::vector<int>& number) {
  std::set<std::array<int, 3>> seen;
  const std::size_t before = mesh.triangles.size();
  std::erase_if(mesh.triangles, [&](const Eigen::Vector3i& t) {
    std::array<int, 3> key{number[std::size_t(t[0])], number[std::size_t(t[1])],
                           number[std::size_t(t[2])]};
    std::sort(key.begin(), key.end());
    if (key[0] == key[1] || key[1] == key[2]) return true;
    const Eigen::Vector3d& a = mesh.positions[std::size_t(t[0])];
    const double area = (mesh.positions[std::size_t(t[1])] - a)
                            .cross(mesh.positions[std::size_t(t[2])] - a)
                            .norm() /
                        2;
    return !(area > kFlatArea_mm2) || !seen.insert(key).second;
  });
  return int(before - mesh.triangles.size());
}

// Turns triangles so that neighbours agree, each connected part the way most of it was.
int TurnAgainstNeighbours(TriangleMesh& mesh, const std::vector<int>& number) {
  const std::size_t n = mesh.triangles.size();
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> users;
  for (std::size_t i = 0; i < n; ++i) {
    for (int k = 0; k < 3; ++k) {
      users[EdgeKey(number[std::size_t(mesh.triangles[i][k])],
                    number[std::size_t(mesh.triangles[i][(k + 1) % 3])])]
          .push_back(i);
    }
  }
  // Whether triangle i walks the edge from position a to b.
  const auto walks = [&](std::size_t i, int a, int b) {
    for (int k = 0; k < 3; ++k) {
      if (number[std::size_t(mesh.triangles[i][k])] == a &&
          number[std::size_t(mesh.triangles[i][(k + 1) % 3])] == b) {
        return true;
      }
    }
    return false;
  };
  std::vector<char> state(n, 0);  // 0 unseen, 1 as it is, 2 to be turned
  int turned = 0;
  for (std::size_t seed = 0; seed < n; ++seed) {
    if (state[seed] != 0) continue;
    std::vector<std::size_t> part = {seed};
    state[seed] = 1;
    for (std::size_t at = 0; at < part.size(); ++at) {
      const std::size_t i = part[at];
      for (int k = 0; k < 3; ++k) {
        const int a = number[std::size_t(mesh.triangles[i][k])];
        const int b = number[std::size_t(mesh.triangles[i][(k + 1) % 3])];
        const std::vector<std::size_t>& both = users[EdgeKey(a, b)];
        if (both.size() != 2) continue;
        const std::size_t j = both[0] == i ? both[1] : both[0];
        if (state[j] != 0) continue;
        const bool same_way = walks(j, a, b);  // neighbours that agree walk it in opposite ways
        state[j] = same_way == (state[i] == 1) ? 2 : 1;
        part.push_back(j);
      }
    }
    const auto turn =
        std::count_if(part.begin(), part.end(), [&](std::size_t i) { return state[i] == 2; });
    const char wrong = 2 * turn > long(part.size()) ? 1 : 2;
    for (const std::size_t i : part) {
      if (state[i] != wrong) continue;
      std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
      ++turned;
    }
  }
  return turned;
}

// Boundary loops, as vertices in the order that a filling walks them.
std::vector<std::vector<int>> BoundaryLoops(const TriangleMesh& mesh,
                                            const std::vector<int>& number) {
  std::map<std::pair<int, int>, int> walked;
  std::map<int, int> vertex_of;  // a vertex at each position
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = number[std::size_t(t[k])], b = number[std::size_t(t[(k + 1) % 3])];
      ++walked[{a, b}];
      vertex_of[a] = t[k];
    }
  }
  std::multimap<int, int> next;  // against the triangles' way
  for (const auto& [edge, count] : walked) {
    if (walked.count({edge.second, edge.first}) == 0 && count == 1) {
      next.emplace(edge.second, edge.first);
    }
  }
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int> loop;
    int at = next.begin()->first;
    for (auto step = next.find(at); step != next.end(); step = next.find(at)) {
      loop.push_back(at);
      at = step->second;
      next.erase(step);
    }
    if (at != loop.front() || loop.size() < 3) continue;
    for (int& position : loop) position = vertex_of[position];
    loops.push_back(std::move(loop));
  }
  return loops;
}

bool FillHole(TriangleMesh& mesh, const std::vector<int>& loop) {
  using HoleKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<HoleKernel::Point_3> points;
  double length = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector3d& p = mesh.positions[std::size_t(loop[i])];
    length += (mesh.positions[std::size_t(loop[(i + 1) % loop.size()])] - p).norm();
    points.emplace_back(p.x(), p.y(), p.z());
  }
  if (length > kLargestHole_mm || loop.size() > kMostHoleEdges) return false;
  std::vector<CGAL::Triple<int, int, int>> triangles;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(points, std::back_inserter(triangles));
  if (triangles.size() != loop.size() - 2) return false;
  // Vertices of its own, so that the edge of the hole stays as sharp as it is.
  const int first = int(mesh.positions.size());
  const bool uvs = mesh.uvs.size() == mesh.positions.size();
  for (const int v : loop) {
    mesh.positions.push_back(Eigen::Vector3d(mesh.positions[std::size_t(v)]));
    if (uvs) mesh.uvs.push_back(Eigen::Vector2f(mesh.uvs[std::size_t(v)]));
  }
  // CGAL's triangles may walk the loop either way.
  int along = 0;
  const int n = int(loop.size());
  for (const auto& t : triangles) {
    const int c[3] = {t.first, t.second, t.third};
    for (int k = 0; k < 3; ++k) {
      along += c[(k + 1) % 3] == (c[k] + 1) % n;
      along -= c[k] == (c[(k + 1) % 3] + 1) % n;
    }
  }
  for (const auto& t : triangles) {
    mesh.triangles.emplace_back(first + t.first, first + (along >= 0 ? t.second : t.third),
                                first + (along >= 0 ? t.third : t.second));
  }
  return true;
}

}  // namespace

MeshRepair& MeshRepair::operator+=(const MeshRepair& other) {
  points_joined += other.points_joined;
  triangles_dropped += other.triangles_dropped;
  triangles_turned += other.triangles_turned;
  pieces_turned += other.pieces_turned;
  holes_filled += other.holes_filled;
  open_edges += other.open_edges;
  crossing_pairs += other.crossing_pairs;
  return *this;
}

std::vector<std::string> MeshRepair::Sentences() const {
  std::vector<std::string> sentences;
  const auto say = [&](int count, const char* one, const char* many) {
    if (count > 0) sentences.push_back(fmt::format("mesh: {} {}", count, count == 1 ? one : many));
  };
  say(points_joined, "point joined to its neighbour", "points joined to their neighbours");
  say(triangles_dropped, "triangle without area or given twice dropped",
      "triangles without area or given twice dropped");
  say(triangles_turned, "triangle turned to face outward", "triangles turned to face outward");
  say(pieces_turned, "piece turned outside out", "pieces turned outside out");
  say(holes_filled, "hole filled", "holes filled");
  say(open_edges, "edge of an open surface kept", "edges of open surfaces kept");
  say(crossing_pairs, "pair of triangles pass through each other, kept",
      "pairs of triangles pass through each other, kept");
  return sentences;
}

int JoinNearPoints(TriangleMesh& mesh) {
  using Cell = std::array<long, 3>;
  std::map<Cell, std::vector<Eigen::Vector3d>> known;
  int moved = 0;
  const auto cell_of = [](const Eigen::Vector3d& p) {
    return Cell{std::lround(std::floor(p.x() / kJoin_mm)),
                std::lround(std::floor(p.y() / kJoin_mm)),
                std::lround(std::floor(p.z() / kJoin_mm))};
  };
  for (Eigen::Vector3d& p : mesh.positions) {
    const Cell home = cell_of(p);
    const Eigen::Vector3d* near = nullptr;
    for (int k = 0; k < 27 && near == nullptr; ++k) {
      const auto found =
          known.find({home[0] + k % 3 - 1, home[1] + k / 3 % 3 - 1, home[2] + k / 9 - 1});
      if (found == known.end()) continue;
      for (const Eigen::Vector3d& q : found->second) {
        if ((q - p).norm() < kJoin_mm) near = &q;
      }
    }
    if (near == nullptr) {
      known[home].push_back(p);
    } else if (*near != p) {
      p = *near;
      ++moved;
    }
  }
  return moved;
}

MeshRepair RepairMesh(TriangleMesh& mesh) {
  MeshRepair report;
  const std::vector<int> number = PositionNumbers(mesh);
  report.triangles_dropped = DropBadTriangles(mesh, number);
  report.triangles_turned = TurnAgainstNeighbours(mesh, number);
  for (const std::vector<int>& loop : BoundaryLoops(mesh, number)) {
    if (FillHole(mesh, loop)) {
      ++report.holes_filled;
    } else {
      report.open_edges += int(loop.size());
    }
  }
  if (mesh.empty()) return report;
  const MeshReport check = CheckMesh(mesh, true);
  report.crossing_pairs = std::max(0, check.self_intersections);
  if (check.closed() && check.volume_mm3 < 0) {
    for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
    for (Eigen::Vector3d& n : mesh.normals) n = -n;
    report.pieces_turned = 1;
  }
  if (report.triangles_turned > 0 || report.holes_filled > 0 ||
      mesh.normals.size() != mesh.positions.size()) {
    ComputeVertexNormals(mesh);
  }
  return report;
}

}  // namespace lorgnette
