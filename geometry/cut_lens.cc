// SPDX-License-Identifier: Apache-2.0
#include "geometry/cut_lens.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/linear_algebra.h"
#include "base/units.h"
#include "geometry/closed_curve.h"
#include "geometry/lens_mesh.h"
#include "optics/base_curve.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

constexpr double kBevelShare = 1.0 / 3;  // of the edge, from the front: where a bevel looks best
constexpr double kOnEdge = 1e-9;         // a ray through a corner meets one of its edges at least

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

// How a lens is seated: where its front vertex lies on the opening's axis, and where the apex of
// its edge is at each point (lens frame).
struct Seat {
  double front_vertex = 0, misfit = 0;
  std::size_t worst = 0;  // the point of the greatest distance to the groove
  std::vector<double> apex;
};

// The apex wanted at a point when the front vertex lies at f (opening coordinates) is f - groove.

// Apexes that are given: the middle of the range of what each point wants.
Seat SeatGiven(const std::vector<double>& apex, const std::vector<double>& groove) {
  double low = kInfinity, high = -kInfinity;
  std::size_t lowest = 0;
  for (std::size_t k = 0; k < groove.size(); ++k) {
    if (groove[k] + apex[k] < low) {
      low = groove[k] + apex[k];
      lowest = k;
    }
    high = std::max(high, groove[k] + apex[k]);
  }
  return {(low + high) / 2, (high - low) / 2, lowest, apex};
}

// Apexes that follow the groove within [least, most] at each point. The greatest distance to the
// groove is a convex function of the front vertex' place: its least value is (highest lower end -
// lowest upper end) / 2, or 0 over a whole range of places, in which the one nearest to the wanted
// share of the edge is taken.
Seat SeatFollowing(const EdgeHeights& edge, const std::vector<double>& groove, double margin) {
  std::vector<double> least(groove.size()), most(groove.size());
  double low = -kInfinity, high = kInfinity, wanted = 0;
  for (std::size_t k = 0; k < groove.size(); ++k) {
    const double thickness = edge.back[k] - edge.front[k];
    // A thin edge keeps its apex within its middle third.
    const double keep = std::min(margin, thickness / 3);
    least[k] = edge.front[k] + keep;
    most[k] = edge.back[k] - keep;
    low = std::max(low, groove[k] + least[k]);
    high = std::min(high, groove[k] + most[k]);
    wanted += (groove[k] + edge.front[k] + kBevelShare * thickness) / double(groove.size());
  }
  Seat seat;
  seat.front_vertex = low <= high ? std::clamp(wanted, low, high) : (low + high) / 2;
  seat.apex.resize(groove.size());
  for (std::size_t k = 0; k < groove.size(); ++k) {
    const double asked = seat.front_vertex - groove[k];
    seat.apex[k] = std::clamp(asked, least[k], most[k]);
    const double off = std::abs(asked - seat.apex[k]);
    if (off > seat.misfit) {
      seat.misfit = off;
      seat.worst = k;
    }
  }
  return seat;
}

// Curvature of the sphere that heights along a contour lie on, wherever its axis is: d of
// z = a + b x + c y + d (x^2 + y^2) / 2.
double CurvatureAlong(const std::vector<Eigen::Vector2d>& contour, const std::vector<double>& z) {
  Eigen::MatrixXd system(Eigen::Index(contour.size()), 4);
  Eigen::VectorXd right(Eigen::Index(contour.size()));
  for (std::size_t k = 0; k < contour.size(); ++k) {
    const Eigen::Vector2d& p = contour[k];
    system.row(Eigen::Index(k)) << 1, p.x(), p.y(), p.squaredNorm() / 2;
    right[Eigen::Index(k)] = z[k];
  }
  return LeastSquares(system, right)[3];
}

// What keeps a bevel from its groove: another curve, or an optical centre beside the middle, since
// the lens stays upright in the rim.
std::string WhyOff(double rim_steeper_D, const Eigen::Vector2d& optical_centre) {
  constexpr double kLikeCurves_D = 0.5;
  if (rim_steeper_D > kLikeCurves_D) return "the lens' front is flatter than the rim";
  if (rim_steeper_D < -kLikeCurves_D) return "the lens' front is more curved than the rim";
  return fmt::format("the lens is decentred by {:.1f} mm", optical_centre.norm());
}

}  // namespace

EdgeForm EdgeFor(FrameMount mount) {
  return mount == FrameMount::kFullRim   ? EdgeForm::kBevel
         : mount == FrameMount::kHalfRim ? EdgeForm::kGroove
                                         : EdgeForm::kFlat;
}

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
  CutLens cut{lens,
              ContourInLensFrame(opening.contour_mm, optical_centre),
              Eigen::Isometry3d::Identity(),
              TriangleMesh{},
              0,
              {},
              {}};
  LG_ASSIGN(const EdgeHeights edge, MeasureEdge(lens.lens(), cut.contour_mm, options));
  std::vector<double> groove(opening.groove_height_mm.rbegin(), opening.groove_height_mm.rend());
  groove.resize(cut.contour_mm.size(), 0.0);

  const EdgeForm form = options.edge.value_or(EdgeForm::kBevel);
  Seat seat;
  if (form == EdgeForm::kBevel && !options.bevel_position) {
    seat = SeatFollowing(edge, groove, options.bevel_margin_mm);
  } else {
    const double share = form == EdgeForm::kBevel ? *options.bevel_position : 0.5;
    std::vector<double> apex;
    for (std::size_t k = 0; k < groove.size(); ++k) {
      apex.push_back(edge.front[k] + share * (edge.back[k] - edge.front[k]));
    }
    seat = SeatGiven(apex, groove);
  }
  cut.mount_misfit_mm = seat.misfit;
  cut.rim_steeper_D =
      1000 * (kToolIndex - 1) *
      (-CurvatureAlong(cut.contour_mm, groove) - CurvatureAlong(cut.contour_mm, edge.front));
  if (form == EdgeForm::kBevel && seat.misfit > kMisfitNote_mm) {
    const Eigen::Vector2d& at = cut.contour_mm[seat.worst];
    cut.notes.push_back(fmt::format(
        "bevel {:.1f} mm off the groove at {:.0f} degrees, where the edge is {:.1f} mm thick: {}",
        seat.misfit, DegreesOf({-at.x(), at.y()}), edge.back[seat.worst] - edge.front[seat.worst],
        WhyOff(cut.rim_steeper_D, optical_centre)));
  }
  cut.frame_from_lens =
      opening.frame_from_opening *
      Eigen::Translation3d(optical_centre.x(), optical_centre.y(), seat.front_vertex) *
      Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitY());

  LensMeshOptions mesh;
  mesh.element_mm = options.element_mm;
  mesh.edge_points = options.edge_points;
  mesh.apex_z_mm = seat.apex;
  if (form == EdgeForm::kBevel) {
    mesh.bevel_height_mm = options.bevel_height_mm;
    mesh.bevel_angle_deg = options.bevel_angle_deg;
  } else if (form == EdgeForm::kGroove) {
    mesh.groove_width_mm = options.groove_width_mm;
    mesh.groove_depth_mm = options.groove_depth_mm;
  }
  cut.apex_z_mm = std::move(seat.apex);
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
      if (u > -kOnEdge && u < 1 + kOnEdge) reach = std::max(reach, r);
    }
    const Eigen::Vector2d at = centre.head<2>() + reach * along;
    const auto front = FrontHit(lens.lens.lens(), at), back = BackHit(lens.lens.lens(), at);
    if (front && back) thickness[std::size_t(k)] = back->point.z() - front->point.z();
  }
  return thickness;
}

}  // namespace lorgnette
