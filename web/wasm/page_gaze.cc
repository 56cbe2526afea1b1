// SPDX-License-Identifier: Apache-2.0
// The maps of the page: what the turning eye meets, and a progressive surface by itself.
#include <cmath>
#include <vector>

#include "optics/gaze.h"
#include "optics/paraxial.h"
#include "optics/power_vector.h"
#include "optics/soft_progressive.h"
#include "page_api.h"
#include "page_slots.h"

namespace {

using lorgnette::EyePose;
using lorgnette::Gaze;
using lorgnette::GazeVergence;
using lorgnette::Lens;
using lorgnette::RayStatus;
using lorgnette::page::kNaN;
using lorgnette::page::Slot;

Eigen::Vector2d Tangents(const Eigen::Vector3d& direction) {
  return direction.head<2>() / direction.z();
}

}  // namespace

const double* lg_gaze_map(int slot_number, double stop_mm, double half_x_mm, double half_y_mm,
                          int n, int m) {
  constexpr std::size_t kRow = 10;
  static std::vector<double> out;
  out.assign(kRow * std::size_t(n) * std::size_t(m), 0);
  double* row = out.data();
  const Slot* slot = lorgnette::page::SlotAt(slot_number);
  if (!slot) {
    for (std::size_t i = 0; i < out.size(); i += kRow) {
      out[i] = double(RayStatus::kMissesSurface);
    }
    return out.data();
  }
  const Lens& lens = slot->lens();
  const Eigen::Matrix2d wanted = lorgnette::LensFrameMatrix(slot->target);
  const EyePose eye = lorgnette::page::EyeBehind(*slot, stop_mm);
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i, row += kRow) {
      const Eigen::Vector3d point(half_x_mm * (2.0 * i / (n - 1) - 1),
                                  half_y_mm * (1 - 2.0 * j / (m - 1)), lens.center_thickness_mm);
      const Eigen::Vector3d looked = eye.axes.transpose() * (point - eye.rotation_center);
      const Gaze gaze{std::atan2(looked.head<2>().norm(), -looked.z()),
                      std::atan2(looked.y(), looked.x())};
      const GazeVergence seen = lorgnette::EvaluateGaze(lens, lens.medium.index_d, eye, gaze);
      row[0] = double(seen.status);
      if (seen.status != RayStatus::kOk) continue;
      const auto error = lorgnette::ErrorsOf(seen, wanted).error;
      // Light travels from the object: its tangents are those of the object's direction.
      const Eigen::Vector2d object = -Tangents(eye.axes.transpose() * seen.object_ray.direction);
      const Eigen::Vector2d eyes = -Tangents(looked);
      row[1] = error.mean;
      row[2] = error.j0;
      row[3] = error.j45;
      row[4] = 100 * (eyes.x() - object.x());
      row[5] = 100 * (eyes.y() - object.y());
      row[6] = object.x();
      row[7] = object.y();
      row[8] = eyes.x();
      row[9] = eyes.y();
    }
  }
  return out.data();
}

const double* lg_gaze_line(int slot_number, double stop_mm, double meridian_deg, double max_deg,
                           int n) {
  static std::vector<double> out;
  out.assign(3 * std::size_t(n + 1), kNaN);
  const Slot* slot = lorgnette::page::SlotAt(slot_number);
  if (!slot) return out.data();
  const Lens& lens = slot->lens();
  const Eigen::Vector2d u = lorgnette::LensFrameDirection(lorgnette::AxisDegrees(meridian_deg));
  const Eigen::Vector2d v(-u.y(), u.x());
  const Eigen::Matrix2d wanted = lorgnette::LensFrameMatrix(slot->target);
  const EyePose eye = lorgnette::page::EyeBehind(*slot, stop_mm);
  for (int i = 0; i <= n; ++i) {
    double* row = out.data() + 3 * i;
    row[0] = max_deg * (2.0 * i / n - 1);
    const Gaze gaze{lorgnette::RadiansFromDegrees(row[0]), std::atan2(u.y(), u.x())};
    const GazeVergence seen = lorgnette::EvaluateGaze(lens, lens.medium.index_d, eye, gaze);
    if (seen.status != RayStatus::kOk) continue;
    row[1] = v.dot(seen.vergence_D * v) - v.dot(wanted * v);
    row[2] = u.dot(seen.vergence_D * u) - u.dot(wanted * u);
  }
  return out.data();
}

const double* lg_progressive_map(double far_D, double add_D, double corridor_mm, double index,
                                 int soft, double half_mm, int n) {
  static std::vector<double> out;
  out.assign(2 * std::size_t(n) * std::size_t(n), kNaN);
  const double per_diopter = 1 / (1000 * (index - 1));
  const lorgnette::ProgressiveSurface hard(far_D * per_diopter, add_D * per_diopter, 0,
                                           corridor_mm);
  lorgnette::Surface surface = hard;
  if (soft) {
    const auto made = lorgnette::SoftProgressive(hard, index, half_mm);
    if (!made) return out.data();
    surface = *made;
  }
  double* pair = out.data();
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i, pair += 2) {
      const double x = half_mm * (2.0 * i / (n - 1) - 1);
      const double y = half_mm * (1 - 2.0 * j / (n - 1));
      const auto power = lorgnette::FrontPowerAt(surface, x, y, index);
      if (!power) continue;
      pair[0] = power->mean;
      pair[1] = power->cylinder;
    }
  }
  return out.data();
}
