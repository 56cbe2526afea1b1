// SPDX-License-Identifier: Apache-2.0
// The maps of the page: what the turning eye meets, and a progressive surface by itself.
#include <cmath>
#include <limits>
#include <vector>

#include "optics/gaze.h"
#include "optics/paraxial.h"
#include "optics/power_vector.h"
#include "page_api.h"
#include "page_slots.h"

namespace {

using lorgnette::EyePose;
using lorgnette::Gaze;
using lorgnette::GazeVergence;
using lorgnette::Lens;
using lorgnette::RayStatus;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The gaze toward (x, y) of the plane through the back vertex.
Gaze Toward(double x, double y, double stop_mm) {
  return {std::atan2(std::hypot(x, y), stop_mm), std::atan2(y, x)};
}

Eigen::Vector2d Tangents(const Eigen::Vector3d& direction) {
  return direction.head<2>() / direction.z();
}

}  // namespace

const double* lg_gaze_map(int slot, double stop_mm, double half_x_mm, double half_y_mm, int n,
                          int m) {
  constexpr std::size_t kRow = 8;
  static std::vector<double> out;
  out.assign(kRow * std::size_t(n) * std::size_t(m), 0);
  const Lens* lens = lorgnette::page::LensIn(slot);
  double* row = out.data();
  if (!lens) {
    for (std::size_t i = 0; i < out.size(); i += kRow) {
      out[i] = double(RayStatus::kMissesSurface);
    }
    return out.data();
  }
  const double index = lens->medium.index_d;
  const Eigen::Matrix2d power = lorgnette::SystemOf(*lens).BackVertexPower();
  const EyePose eye = EyePose::OnAxis(*lens, stop_mm);
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i, row += kRow) {
      const double x = half_x_mm * (2.0 * i / (n - 1) - 1);
      const double y = half_y_mm * (1 - 2.0 * j / (m - 1));
      const Gaze gaze = Toward(x, y, stop_mm);
      const GazeVergence seen = lorgnette::EvaluateGaze(*lens, index, eye, gaze);
      row[0] = double(seen.status);
      if (seen.status != RayStatus::kOk) continue;
      const auto error = lorgnette::ErrorsOf(seen, power).error;
      // Light travels from the object: its tangents are those of the object's direction.
      const Eigen::Vector2d object = -Tangents(seen.object_ray.direction);
      const Eigen::Vector2d looked = -Tangents(-gaze.Direction());
      row[1] = error.mean;
      row[2] = error.j0;
      row[3] = error.j45;
      row[4] = 100 * (looked.x() - object.x());
      row[5] = 100 * (looked.y() - object.y());
      row[6] = object.x();
      row[7] = object.y();
    }
  }
  return out.data();
}

const double* lg_gaze_line(int slot, double stop_mm, double meridian_deg, double max_deg, int n) {
  static std::vector<double> out;
  out.assign(3 * std::size_t(n + 1), kNaN);
  const Lens* lens = lorgnette::page::LensIn(slot);
  if (!lens) return out.data();
  const Eigen::Vector2d u = lorgnette::LensFrameDirection(lorgnette::AxisDegrees(meridian_deg));
  const Eigen::Vector2d v(-u.y(), u.x());
  const Eigen::Matrix2d power = lorgnette::SystemOf(*lens).BackVertexPower();
  const EyePose eye = EyePose::OnAxis(*lens, stop_mm);
  for (int i = 0; i <= n; ++i) {
    double* row = out.data() + 3 * i;
    row[0] = max_deg * i / n;
    const Gaze gaze{lorgnette::RadiansFromDegrees(row[0]), std::atan2(u.y(), u.x())};
    const GazeVergence seen = lorgnette::EvaluateGaze(*lens, lens->medium.index_d, eye, gaze);
    if (seen.status != RayStatus::kOk) continue;
    row[1] = v.dot(seen.vergence_D * v) - v.dot(power * v);
    row[2] = u.dot(seen.vergence_D * u) - u.dot(power * u);
  }
  return out.data();
}

const double* lg_progressive_map(double far_D, double add_D, double corridor_mm, double index,
                                 double half_mm, int n) {
  static std::vector<double> out;
  out.assign(2 * std::size_t(n) * std::size_t(n), kNaN);
  const double per_diopter = 1 / (1000 * (index - 1));
  const lorgnette::Surface surface =
      lorgnette::ProgressiveSurface(far_D * per_diopter, add_D * per_diopter, 0, corridor_mm);
  double* pair = out.data();
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i, pair += 2) {
      const double x = half_mm * (2.0 * i / (n - 1) - 1);
      const double y = half_mm * (1 - 2.0 * j / (n - 1));
      const auto jet = surface.Jet(x, y);
      if (!jet) continue;
      // Mean and Gaussian curvature of a graph; docs/optics.md, "Surfaces".
      const double w = 1 + jet->zx * jet->zx + jet->zy * jet->zy;
      const double mean = ((1 + jet->zy * jet->zy) * jet->zxx - 2 * jet->zx * jet->zy * jet->zxy +
                           (1 + jet->zx * jet->zx) * jet->zyy) /
                          (2 * w * std::sqrt(w));
      const double gauss = (jet->zxx * jet->zyy - jet->zxy * jet->zxy) / (w * w);
      pair[0] = mean / per_diopter;
      pair[1] = 2 * std::sqrt(std::max(0.0, mean * mean - gauss)) / per_diopter;
    }
  }
  return out.data();
}
