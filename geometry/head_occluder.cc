// SPDX-License-Identifier: Apache-2.0
#include "geometry/head_occluder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/units.h"
#include "geometry/sweep.h"

namespace lorgnette {
namespace {

// Mean adult head (head breadth 150 mm at the ears); scaled by the ears' distance.
constexpr double kMeanEarBreadth_mm = 150;
constexpr double kOcciput_mm = -182;  // z of the back of the head
constexpr double kCrownRise_mm = 58;  // how far the crown stands above the forehead's edge
constexpr double kEarHalfHeight_mm = 30, kEarHalfWidth_mm = 17, kEarHalfThickness_mm = 4;
constexpr double kEarStandOff_deg = 28;  // from the side of the head
constexpr double kEarLean_deg = 12;      // backward from the vertical
constexpr double kEarAboveRoot_mm = 6;   // its top over its upper root
constexpr int kSkullRings = 28;

double Scale(const EarPoints& ears) { return (ears.left - ears.right).norm() / kMeanEarBreadth_mm; }

TriangleMesh Skull(const TriangleMesh& face, const std::vector<int>& outline, double scale) {
  const int n = int(outline.size());
  Eigen::Vector3d middle(0, 0, 0);
  double top = 0;
  for (const int v : outline) {
    const Eigen::Vector3d& p = face.positions[std::size_t(v)];
    middle += p / n;
    top = std::max(top, p.y());
  }
  TriangleMesh skull;
  for (int ring = 0; ring < kSkullRings; ++ring) {
    const double angle = kPi / 2 * ring / kSkullRings;
    const double shrink = std::pow(std::cos(angle), 0.55);
    for (const int v : outline) {
      const Eigen::Vector3d& p = face.positions[std::size_t(v)];
      const double up = top > 0 ? std::clamp(p.y() / top, 0.0, 1.0) : 0;
      Eigen::Vector3d q = middle + shrink * (p - middle);
      q.z() = p.z() + (kOcciput_mm * scale - p.z()) * std::sin(angle);
      q.y() += up * up * kCrownRise_mm * scale * std::pow(std::sin(2 * angle), 0.8);
      skull.positions.push_back(q);
    }
  }
  const int back = int(skull.positions.size());
  skull.positions.emplace_back(middle.x(), middle.y(), kOcciput_mm * scale);
  // Far enough behind the face that no skin lies behind the cap.
  double deepest = 0;
  for (const int v : outline) deepest = std::min(deepest, face.positions[std::size_t(v)].z());
  const int cap = back + 1;
  skull.positions.emplace_back(middle.x(), middle.y(), deepest);
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    for (int ring = 0; ring + 1 < kSkullRings; ++ring) {
      const int a = ring * n, b = a + n;
      skull.triangles.emplace_back(a + i, a + j, b + j);
      skull.triangles.emplace_back(a + i, b + j, b + i);
    }
    const int last = (kSkullRings - 1) * n;
    skull.triangles.emplace_back(last + i, last + j, back);
    skull.triangles.emplace_back(j, i, cap);
  }
  if (SignedVolume(skull) < 0) {
    for (Eigen::Vector3i& t : skull.triangles) std::swap(t[1], t[2]);
  }
  ComputeVertexNormals(skull);
  return skull;
}

TriangleMesh Ear(const Eigen::Vector3d& root, double side, double scale) {
  const double stand = RadiansFromDegrees(kEarStandOff_deg),
               lean = RadiansFromDegrees(kEarLean_deg);
  const Eigen::Vector3d back(side * std::sin(stand), 0, -std::cos(stand));  // root edge to helix
  const Eigen::Vector3d up0(0, std::cos(lean), -std::sin(lean));
  const Eigen::Vector3d thick = back.cross(up0).normalized();
  const Eigen::Vector3d up = thick.cross(back);
  const Eigen::Vector3d centre =
      root + scale * (kEarHalfWidth_mm * back + (kEarAboveRoot_mm - kEarHalfHeight_mm) * up);
  const VolumeMap map = [&](double v, double q, double w) -> Eigen::Vector3d {
    const double l = 2 * v - 1;
    // Wider above than at the lobe.
    const double width = kEarHalfWidth_mm * (1 + 0.18 * l);
    return centre + scale * (l * kEarHalfHeight_mm * up + q * width * back +
                             w * kEarHalfThickness_mm * thick);
  };
  BarShape shape;
  shape.section = Superellipse(24, 2);
  shape.rings = 4;
  shape.dome_rings = 9;
  shape.dome_start = shape.dome_end = 0.45;
  return SweepBar(map, shape);
}

}  // namespace

std::vector<int> LongestBoundary(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> walked;  // directed edges
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++walked[{t[k], t[(k + 1) % 3]}];
  }
  std::map<int, int> next;
  for (const auto& [edge, count] : walked) {
    if (walked.count({edge.second, edge.first}) == 0) next[edge.first] = edge.second;
  }
  std::vector<int> longest;
  double longest_mm = 0;
  while (!next.empty()) {
    std::vector<int> loop;
    int at = next.begin()->first;
    double length = 0;
    for (auto step = next.find(at); step != next.end(); step = next.find(at)) {
      loop.push_back(at);
      at = step->second;
      length += (mesh.positions[std::size_t(at)] - mesh.positions[std::size_t(loop.back())]).norm();
      next.erase(step);
    }
    if (at == loop.front() && length > longest_mm) {
      longest_mm = length;
      longest = std::move(loop);
    }
  }
  return longest;
}

TriangleMesh BuildHeadOccluder(const TriangleMesh& face, const EarPoints& ears) {
  const std::vector<int> outline = LongestBoundary(face);
  if (outline.size() < 8) return {};
  const double scale = Scale(ears);
  TriangleMesh head = Skull(face, outline, scale);
  Append(head, Ear(ears.right, -1, scale));
  Append(head, Ear(ears.left, 1, scale));
  return head;
}

}  // namespace lorgnette
