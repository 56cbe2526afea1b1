// SPDX-License-Identifier: Apache-2.0
#include "geometry/sweep.h"

#include <Eigen/Geometry>
#include <cmath>

#include "base/check.h"
#include "base/units.h"

namespace lorgnette {
namespace {

// Step of central differences in parameters of order one: error of order 1e-10 of the size.
constexpr double kStep = 1e-5;

double SignedPower(double x, double e) { return std::copysign(std::pow(std::abs(x), e), x); }

Eigen::Vector3d RingNormal(const Eigen::Vector3d& tangent, const Eigen::Vector3d& along) {
  const Eigen::Vector3d n = tangent.cross(along);
  const double length = n.norm();
  return length > 0 ? Eigen::Vector3d(n / length) : Eigen::Vector3d(0, 0, 1);
}

void AppendRing(RingGrid& grid, const RingFunction& ring, double s) {
  const Ring here = ring(s), before = ring(s - kStep), after = ring(s + kStep);
  std::vector<Eigen::Vector3d> points, normals;
  for (std::size_t i = 0; i < here.size(); ++i) {
    points.push_back(here[i].position);
    normals.push_back(RingNormal(here[i].tangent, after[i].position - before[i].position));
  }
  grid.AddRing(points, normals);
}

void OrientOutward(TriangleMesh& mesh) {
  if (SignedVolume(mesh) < 0) {
    for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  // Analytic normals agree with the triangles everywhere or nowhere.
  double agreement = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.positions[std::size_t(t[0])];
    const Eigen::Vector3d n =
        (mesh.positions[std::size_t(t[1])] - a).cross(mesh.positions[std::size_t(t[2])] - a);
    for (int k = 0; k < 3; ++k) agreement += n.dot(mesh.normals[std::size_t(t[k])]);
  }
  if (agreement < 0) {
    for (Eigen::Vector3d& n : mesh.normals) n = -n;
  }
}

}  // namespace

Section Superellipse(int n, double exponent) {
  Section section;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * kPi * i / n;
    const Eigen::Vector2d p(SignedPower(std::cos(angle), 2 / exponent),
                            SignedPower(std::sin(angle), 2 / exponent));
    const Eigen::Vector2d normal(SignedPower(p.x(), exponent - 1),
                                 SignedPower(p.y(), exponent - 1));
    section.points.push_back(p);
    section.tangents.push_back(Eigen::Vector2d(-normal.y(), normal.x()).normalized());
  }
  return section;
}

Section RoundedPolygon(const std::vector<Eigen::Vector2d>& corners,
                       const std::vector<double>& radii, int per_corner) {
  LG_CHECK_EQ(corners.size(), radii.size());
  LG_CHECK_GE(per_corner, 2);
  Section section;
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d& corner = corners[i];
    const Eigen::Vector2d in = (corner - corners[(i + n - 1) % n]).normalized();
    const Eigen::Vector2d out = (corners[(i + 1) % n] - corner).normalized();
    const double turn = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
    if (radii[i] <= 0 || std::abs(turn) < 1e-6) {
      section.points.push_back(corner);
      section.tangents.push_back((in + out).normalized());
      continue;
    }
    // The arc leaves the edges at radius * tan(turn / 2) from the corner.
    const double side = turn > 0 ? 1 : -1;
    const Eigen::Vector2d start = corner - in * (radii[i] * std::tan(std::abs(turn) / 2));
    const Eigen::Vector2d centre = start + side * radii[i] * Eigen::Vector2d(-in.y(), in.x());
    for (int k = 0; k < per_corner; ++k) {
      const double angle = turn * k / (per_corner - 1);
      const Eigen::Rotation2Dd rotation(angle);
      section.points.push_back(centre + rotation * (start - centre));
      section.tangents.push_back(rotation * in);
    }
  }
  return section;
}

TriangleMesh SweepClosed(const RingFunction& ring, const std::vector<double>& parameters,
                         const MeshFineness& fineness) {
  RingGrid grid(ring(parameters.front()).size());
  for (const double s : parameters) AppendRing(grid, ring, s);
  TriangleMesh mesh = grid.Thinned(fineness, /*closed=*/true).Mesh(/*closed=*/true);
  OrientOutward(mesh);
  return mesh;
}

TriangleMesh SweepBar(const VolumeMap& volume_map, const BarShape& shape) {
  const int n = int(shape.section.points.size());
  // s in [0, 1]: start dome; [1, 2]: body; [2, 3]: end dome. In a dome the section shrinks as the
  // sine of an angle while v advances by its cosine.
  const RingFunction ring = [&](double s) {
    double v = 0, scale = 1;
    if (s < 1) {
      v = shape.dome_start * (1 - std::cos(s * kPi / 2));
      scale = std::sin(s * kPi / 2);
    } else if (s > 2) {
      v = 1 - shape.dome_end * (1 - std::cos((3 - s) * kPi / 2));
      scale = std::sin((3 - s) * kPi / 2);
    } else {
      v = shape.dome_start + (s - 1) * (1 - shape.dome_start - shape.dome_end);
    }
    Ring points(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d p = scale * shape.section.points[i];
      const Eigen::Vector2d d = kStep * shape.section.tangents[i];
      points[i].position = volume_map(v, p.x(), p.y());
      points[i].tangent = (volume_map(v, p.x() + d.x(), p.y() + d.y()) -
                           volume_map(v, p.x() - d.x(), p.y() - d.y())) /
                          (2 * kStep);
    }
    return points;
  };

  std::vector<double> parameters;
  for (int k = 1; k <= shape.dome_rings; ++k) parameters.push_back(double(k) / shape.dome_rings);
  for (int k = 1; k < shape.rings; ++k) parameters.push_back(1 + double(k) / shape.rings);
  for (int k = 0; k < shape.dome_rings; ++k) parameters.push_back(2 + double(k) / shape.dome_rings);

  RingGrid fine(shape.section.points.size());
  for (const double s : parameters) AppendRing(fine, ring, s);
  const RingGrid grid = shape.fineness ? fine.Thinned(*shape.fineness, /*closed=*/false) : fine;
  TriangleMesh mesh = grid.Mesh(/*closed=*/false);
  const int rings = int(grid.rings()), around = int(grid.points_a_ring());
  for (const bool end : {false, true}) {
    const int pole = int(mesh.positions.size());
    const double v = end ? 1 : 0;
    const Eigen::Vector3d along_q = volume_map(v, kStep, 0) - volume_map(v, -kStep, 0);
    const Eigen::Vector3d along_w = volume_map(v, 0, kStep) - volume_map(v, 0, -kStep);
    mesh.positions.push_back(volume_map(v, 0, 0));
    mesh.normals.push_back((end ? 1 : -1) * along_q.cross(along_w).normalized());
    const int base = end ? (rings - 1) * around : 0;
    for (int i = 0; i < around; ++i) {
      const int j = (i + 1) % around;
      if (end) {
        mesh.triangles.emplace_back(base + i, base + j, pole);
      } else {
        mesh.triangles.emplace_back(base + j, base + i, pole);
      }
    }
  }
  OrientOutward(mesh);
  return mesh;
}

double SignedVolume(const TriangleMesh& mesh) {
  double six = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    six += mesh.positions[std::size_t(t[0])].dot(
        mesh.positions[std::size_t(t[1])].cross(mesh.positions[std::size_t(t[2])]));
  }
  return six / 6;
}

}  // namespace lorgnette
