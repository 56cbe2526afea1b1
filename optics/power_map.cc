// SPDX-License-Identifier: Apache-2.0
#include "optics/power_map.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "optics/coddington.h"
#include "optics/lens_kernel.h"
#include "optics/media.h"
#include "optics/paraxial.h"

namespace lorgnette {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// So many rays are traced at a time, in the same small buffers: a fresh page costs more than a ray.
constexpr std::size_t kChunk = 1024;

// Rays from the centre of rotation outward, and what the kernel says of them.
struct OutwardRays {
  void Resize(std::size_t count) {
    n = count;
    for (std::vector<double>* v : {&in, &exit, &first, &inside}) v->resize(6 * n);
    status.resize(n);
  }

  std::size_t n = 0;
  std::vector<double> in, exit, first, inside;
  std::vector<std::uint8_t> status;

  RayArrays<double> Arrays(std::vector<double>& v) const {
    return {v.data(),         v.data() + n,     v.data() + 2 * n,
            v.data() + 3 * n, v.data() + 4 * n, v.data() + 5 * n};
  }
  void Trace(const Lens& lens, double index) {
    RayArrays<double> a = Arrays(first), b = Arrays(inside);
    const double* d = in.data();
    TraceLensBatch(lens, index, {d, d + n, d + 2 * n, d + 3 * n, d + 4 * n, d + 5 * n}, n,
                   {Arrays(exit), status.data(), &a, &b});
  }
  Vector3d Point(const std::vector<double>& v, std::size_t i) const {
    return {v[i], v[n + i], v[2 * n + i]};
  }
  Vector3d Direction(const std::vector<double>& v, std::size_t i) const {
    return {v[3 * n + i], v[4 * n + i], v[5 * n + i]};
  }
};

// Angle between unit vectors as 100 tan, with the sign lost.
double PrismBetween(const Vector3d& a, const Vector3d& b) {
  return 100 * a.cross(b).norm() / a.dot(b);
}

// Tangents of the object ray per tangent of the gaze, to first order: from the centre of rotation
// back through the lens.
Eigen::Matrix2d ParaxialAngles(const Lens& lens, double index, double stop_mm) {
  // (0, u) at the centre, u toward the eye: height -stop u at the back vertex; the inverse of
  // [A B; C D] takes it to the object side.
  const Eigen::Matrix4d m = SystemOf(lens, index).Matrix().inverse();
  return m.block<2, 2>(2, 0) * (-stop_mm / 1000) + m.block<2, 2>(2, 2);
}

}  // namespace

PowerMap MakePowerMap(const Lens& lens, double index, const PowerMapOptions& options) {
  LG_CHECK_GE(options.size, 2);
  PowerMap map;
  map.size = options.size;
  map.half_angle_deg = options.half_angle_deg;
  map.points.resize(std::size_t(options.size) * std::size_t(options.size));

  const EyePose eye = EyePose::OnAxis(lens, options.stop_mm);
  const double reach = std::tan(RadiansFromDegrees(options.half_angle_deg));
  std::vector<std::size_t> used;
  std::vector<Vector2d> tangents;
  for (int j = 0; j < options.size; ++j) {
    for (int i = 0; i < options.size; ++i) {
      const double step = 2 * reach / (options.size - 1);
      const Vector2d tangent(-reach + i * step, reach - j * step);
      if (tangent.norm() > reach * (1 + 1e-12)) continue;
      used.push_back(std::size_t(j) * std::size_t(options.size) + std::size_t(i));
      tangents.push_back(tangent);
    }
  }

  const Eigen::Matrix2d paraxial = ParaxialAngles(lens, index, options.stop_mm);
  OutwardRays rays, rays_f, rays_c;
  for (std::size_t begin = 0; begin < used.size(); begin += kChunk) {
    rays.Resize(std::min(kChunk, used.size() - begin));
    for (std::size_t k = 0; k < rays.n; ++k) {
      const Vector2d& tangent = tangents[begin + k];
      const Vector3d d = Vector3d(tangent.x(), tangent.y(), -1).normalized();
      const double values[] = {eye.rotation_center.x(),
                               eye.rotation_center.y(),
                               eye.rotation_center.z(),
                               d.x(),
                               d.y(),
                               d.z()};
      for (std::size_t f = 0; f < 6; ++f) rays.in[f * rays.n + k] = values[f];
    }
    rays.Trace(lens, index);
    if (options.lateral_colour) {
      const double d_line = IndexAt(lens.medium, kLineD_nm);
      rays_f.Resize(rays.n);
      rays_c.Resize(rays.n);
      rays_f.in = rays_c.in = rays.in;
      rays_f.Trace(lens, index + IndexAt(lens.medium, kLineF_nm) - d_line);
      rays_c.Trace(lens, index + IndexAt(lens.medium, kLineC_nm) - d_line);
    }

    for (std::size_t k = 0; k < rays.n; ++k) {
      MapPoint& point = map.points[used[begin + k]];
      point.status = RayStatus(rays.status[k]);
      if (point.status != RayStatus::kOk) continue;
      const Vector3d gaze = rays.Direction(rays.in, k);

      LensTrace forward;
      forward.status = RayStatus::kOk;
      forward.first.point = rays.Point(rays.exit, k);
      forward.second.point = rays.Point(rays.first, k);
      forward.inside_direction = -rays.Direction(rays.inside, k);
      forward.exit = {forward.second.point, -gaze};
      const Ray object{forward.first.point, -rays.Direction(rays.exit, k)};
      const auto exit =
          WavefrontThrough(lens, index, forward, SphericalWave(object, -1000 / options.object_mm));
      if (!exit) {
        point.status = RayStatus::kMissesSurface;
        continue;
      }
      const double to_center = (eye.rotation_center - forward.exit.origin).dot(-gaze);
      const Wavefront sphere = Propagated(*exit, to_center - options.stop_mm, 1);
      const Eigen::Matrix<double, 3, 2> across = ListingRotation(gaze).leftCols<2>();
      const Eigen::Matrix2d vergence = across.transpose() * sphere.vergence_D * across;
      point.power = PowerVectorOfLensFrame(vergence);
      point.front_mm = forward.first.point.head<2>();

      const Vector3d& leaving = forward.exit.direction;
      const Vector2d bent = (leaving - object.direction * leaving.dot(object.direction)).head<2>();
      const double size = bent.norm();
      if (size > 0) point.prism = PrismBetween(object.direction, leaving) / size * bent;

      const Vector2d seen = -tangents[begin + k];  // slopes of the light, which travels +z
      const Vector2d expected = paraxial * seen;
      const Vector2d slope = object.direction.head<2>() / object.direction.z();
      if (expected.norm() > 0) point.distortion = slope.dot(expected) / expected.squaredNorm() - 1;
      if (options.lateral_colour && RayStatus(rays_f.status[k]) == RayStatus::kOk &&
          RayStatus(rays_c.status[k]) == RayStatus::kOk) {
        point.lateral_colour =
            PrismBetween(rays_f.Direction(rays_f.exit, k), rays_c.Direction(rays_c.exit, k));
      }
    }
  }
  return map;
}

MapSummary Summarize(const PowerMap& map) {
  MapSummary summary;
  const auto include = [](MapRange& range, double value) {
    range.least = std::min(range.least, value);
    range.greatest = std::max(range.greatest, value);
  };
  for (const MapPoint& point : map.points) {
    if (point.status != RayStatus::kOk) continue;
    ++summary.points;
    include(summary.mean_power_D, point.power.mean);
    include(summary.cylinder_D, 2 * std::hypot(point.power.j0, point.power.j45));
    include(summary.prism, point.prism.norm());
    include(summary.distortion, point.distortion);
    include(summary.lateral_colour, point.lateral_colour);
  }
  return summary;
}

}  // namespace lorgnette
