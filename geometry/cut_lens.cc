// SPDX-License-Identifier: Apache-2.0
#include "geometry/cut_lens.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "geometry/closed_curve.h"
#include "geometry/lens_mesh.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

constexpr double kMinBevelPosition = 0.25, kMaxBevelPosition = 0.5;
constexpr int kBevelPositionsTried = 26;

double DegreesOf(const Eigen::Vector2d& p) {
  const double degrees = DegreesFromRadians(std::atan2(p.y(), p.x()));
  return degrees < 0 ? degrees + 360 : degrees;
}

// Heights of both surfaces over each contour point, lens frame.
struct EdgeHeights {
  std::vector<double> front, back;
};

Result<EdgeHeights> MeasureEdge(const Lens& lens, const std::vector<Eigen::Vector2d>& contour,
                                const CutOptions& options) {
  EdgeHeights heights;
  for (const Eigen::Vector2d& p : contour) {
    if (p.norm() > options.blank_diameter_mm / 2) {
      double reach = 0;
      for (const Eigen::Vector2d& q : contour) reach = std::max(reach, q.norm());
      return Failure(fmt::format(
          "cut: blank too small: got {:.1f} mm, want {:.1f} mm, since the contour reaches {:.1f} "
          "mm from the optical centre",
          options.blank_diameter_mm, 2 * reach, reach));
    }
    const auto front = FrontHit(lens, p), back = BackHit(lens, p);
    if (!front || !back) {
      return Failure(fmt::format(
          "cut: the {} surface ends inside the contour, {:.1f} mm from the optical centre",
          front ? "back" : "front", p.norm()));
    }
    const double thickness = back->point.z() - front->point.z();
    if (thickness < options.min_edge_mm) {
      return Failure(fmt::format(
          "cut: lens thinner than its rim needs: got {:.2f} mm at {:.0f} degrees, want {:.2f} mm",
          thickness, DegreesOf(p), options.min_edge_mm));
    }
    heights.front.push_back(front->point.z());
    heights.back.push_back(back->point.z());
  }
  return heights;
}

// Where the front vertex must lie on the opening's axis for the apex to meet the groove at each
// point: the middle of the range, and half the range.
struct Seat {
  double front_vertex = 0, misfit = std::numeric_limits<double>::infinity();
};
Seat SeatWith(double position, const EdgeHeights& edge, const std::vector<double>& groove) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t k = 0; k < groove.size(); ++k) {
    const double apex = edge.front[k] + position * (edge.back[k] - edge.front[k]);
    low = std::min(low, groove[k] + apex);
    high = std::max(high, groove[k] + apex);
  }
  return {(low + high) / 2, (high - low) / 2};
}

}  // namespace

std::vector<Eigen::Vector2d> ContourInLensFrame(const std::vector<Eigen::Vector2d>& contour_mm,
                                                const Eigen::Vector2d& optical_centre) {
  std::vector<Eigen::Vector2d> mirrored(contour_mm.rbegin(), contour_mm.rend());
  for (Eigen::Vector2d& p : mirrored) {
    p = {optical_centre.x() - p.x(), p.y() - optical_centre.y()};
  }
  return mirrored;
}

Result<CutLens> CutAndMount(const CertifiedLens& lens, const LensOpening& opening,
                            const Eigen::Vector2d& optical_centre, const CutOptions& options) {
  CutLens cut{lens, ContourInLensFrame(opening.contour_mm, optical_centre),
              Eigen::Isometry3d::Identity(), TriangleMesh{}, 0};
  LG_ASSIGN(const EdgeHeights edge, MeasureEdge(lens.lens(), cut.contour_mm, options));
  std::vector<double> groove(opening.groove_height_mm.rbegin(), opening.groove_height_mm.rend());
  groove.resize(cut.contour_mm.size(), 0.0);

  double position = options.bevel_position.value_or(0.5);
  Seat seat = SeatWith(position, edge, groove);
  if (options.edge == EdgeForm::kBevel && !options.bevel_position) {
    for (int k = 0; k < kBevelPositionsTried; ++k) {
      const double tried = kMinBevelPosition +
                           (kMaxBevelPosition - kMinBevelPosition) * k / (kBevelPositionsTried - 1);
      const Seat with = SeatWith(tried, edge, groove);
      if (with.misfit < seat.misfit) {
        seat = with;
        position = tried;
      }
    }
  }
  cut.mount_misfit_mm = seat.misfit;
  cut.frame_from_lens =
      opening.frame_from_opening *
      Eigen::Translation3d(optical_centre.x(), optical_centre.y(), seat.front_vertex) *
      Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitY());

  LensMeshOptions mesh;
  mesh.element_mm = options.element_mm;
  mesh.edge_points = options.edge_points;
  mesh.bevel_height_mm = options.edge == EdgeForm::kBevel ? options.bevel_height_mm : 0;
  mesh.bevel_angle_deg = options.bevel_angle_deg;
  mesh.bevel_position = position;
  LG_ASSIGN(cut.mesh, BuildLensMesh(lens.lens(), cut.contour_mm, mesh));
  return cut;
}

std::vector<double> EdgeThicknessByAngle(const CutLens& lens, const LensOpening& opening,
                                         int count) {
  const Eigen::Vector3d centre =
      lens.frame_from_lens.inverse() * opening.frame_from_opening.translation();
  std::vector<double> thickness(static_cast<std::size_t>(count), 0.0);
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * kPi * k / count;
    const Eigen::Vector2d along(-std::cos(angle), std::sin(angle));  // lens frame: x mirrored
    double reach = 0;
    const auto& contour = lens.contour_mm;
    for (std::size_t i = 0; i < contour.size(); ++i) {
      const Eigen::Vector2d a = contour[i] - centre.head<2>();
      const Eigen::Vector2d edge = contour[(i + 1) % contour.size()] - contour[i];
      const double crossing = along.x() * edge.y() - along.y() * edge.x();
      if (crossing == 0) continue;
      const double r = (a.x() * edge.y() - a.y() * edge.x()) / crossing;
      const double u = (a.x() * along.y() - a.y() * along.x()) / crossing;
      if (u >= 0 && u <= 1) reach = std::max(reach, r);
    }
    const Eigen::Vector2d at = centre.head<2>() + reach * along;
    const auto front = FrontHit(lens.lens.lens(), at), back = BackHit(lens.lens.lens(), at);
    if (front && back) thickness[std::size_t(k)] = back->point.z() - front->point.z();
  }
  return thickness;
}

}  // namespace lorgnette
