// SPDX-License-Identifier: Apache-2.0
#include "geometry/rim_shape.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace lorgnette {
namespace {

constexpr double kToolingPower = 530;  // D * mm: 1000 (1.530 - 1)
constexpr int kAnglesSearched = 2048;
constexpr double kLipRounding_mm = 0.12;
constexpr int kRings = 288;  // before those that a mesh does not need are left out

double Sag(double curvature, double squared_radius) {
  return curvature * squared_radius /
         (1 + std::sqrt(std::max(0.0, 1 - curvature * curvature * squared_radius)));
}

}  // namespace

RimShape::RimShape(const FrameParameters& parameters)
    : rim_(parameters.rim),
      outline_(ClosedSpline(parameters.outline).FittedToBox(parameters.a_mm, parameters.b_mm)),
      curvature_(parameters.frame_curve_diopters / kToolingPower) {
  const Polygon2 contour = outline_.Sample(outline_.ArcLengthParameters(512));
  for (const Eigen::Vector2d& p : contour) {
    mean_sag_ += Sag(curvature_, p.squaredNorm()) / double(contour.size());
  }
  frame_from_opening_ =
      Eigen::Translation3d((parameters.a_mm + parameters.dbl_mm) / 2, 0, 0) *
      Eigen::AngleAxisd(RadiansFromDegrees(parameters.face_form_deg), Eigen::Vector3d::UnitY());
}

double RimShape::Width(double s) const {
  const Eigen::Vector2d n = outline_.OutwardNormal(s);
  const double x = n.x() * n.x(), y = n.y() * n.y();
  double width = x * (n.x() > 0 ? rim_.temporal_mm : rim_.nasal_mm) +
                 y * (n.y() > 0 ? rim_.top_mm : rim_.bottom_mm);
  for (const RimFlare& flare : rim_.flares) {
    const double angle = RadiansFromDegrees(flare.angle_deg);
    const double away =
        std::acos(std::clamp(n.x() * std::cos(angle) + n.y() * std::sin(angle), -1.0, 1.0));
    const double spread = RadiansFromDegrees(flare.spread_deg);
    width += flare.width_mm * std::exp(-0.5 * away * away / (spread * spread));
  }
  return width;
}

double RimShape::GrooveHeight(const Eigen::Vector2d& p) const {
  return mean_sag_ - Sag(curvature_, p.squaredNorm());
}

Eigen::Vector3d RimShape::Point(double s, double u, double w) const {
  const Eigen::Vector2d p = outline_.Point(s) + u * outline_.OutwardNormal(s);
  return frame_from_opening_ * Eigen::Vector3d(p.x(), p.y(), GrooveHeight(p) + w);
}

double RimShape::ParameterAtAngle(double angle_deg) const {
  const double angle = RadiansFromDegrees(angle_deg);
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  double best = 0, best_cosine = -2;
  for (int k = 0; k < kAnglesSearched; ++k) {
    const double s = double(k) / kAnglesSearched;
    const double cosine = outline_.Point(s).normalized().dot(along);
    if (cosine > best_cosine) {
      best_cosine = cosine;
      best = s;
    }
  }
  return best;
}

double RimShape::OuterReach() const {
  double reach = 0;
  for (int k = 0; k < kAnglesSearched; ++k) {
    const double s = double(k) / kAnglesSearched;
    reach = std::max(reach, Point(s, Width(s), 0).x());
  }
  return reach;
}

LensOpening RimShape::Opening(int points) const {
  LensOpening opening;
  opening.frame_from_opening = frame_from_opening_;
  const std::vector<double> parameters = outline_.ArcLengthParameters(points);
  opening.contour_mm = outline_.Sample(parameters);
  opening.aperture_mm = outline_.Sample(parameters, -rim_.lip_mm);
  for (const Eigen::Vector2d& p : opening.contour_mm) {
    opening.groove_height_mm.push_back(GrooveHeight(p));
  }
  return opening;
}

Section RimShape::SectionAt(double s) const {
  const double width = Width(s), depth = rim_.depth_mm / 2, lip = rim_.lip_mm;
  const double groove = rim_.groove_width_mm / 2;
  const double round = std::min(rim_.rounding_mm, 0.45 * (width + lip));
  const double inner = std::min(0.35 * (depth - groove), 0.5 * round);
  return RoundedPolygon({{width, -depth},
                         {width, depth},
                         {-lip, depth},
                         {-lip, groove},
                         {0, 0},
                         {-lip, -groove},
                         {-lip, -depth}},
                        {round, round, inner, std::min(kLipRounding_mm, 0.3 * lip), 0,
                         std::min(kLipRounding_mm, 0.3 * lip), inner},
                        13);
}

TriangleMesh RimShape::Mesh(const MeshFineness& fineness) const {
  const RingFunction ring = [this](double s) {
    const Section section = SectionAt(s);
    const Eigen::Vector2d p = outline_.Point(s), n = outline_.OutwardNormal(s);
    const Eigen::Matrix3d rotation = frame_from_opening_.linear();
    Ring points(section.points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double u = section.points[i].x(), w = section.points[i].y();
      const Eigen::Vector2d at = p + u * n;
      const double height = GrooveHeight(at);
      points[i].position = frame_from_opening_ * Eigen::Vector3d(at.x(), at.y(), height + w);
      // The section is sheared by the slope of the frame curve along n.
      const double slope = (GrooveHeight(at + 1e-4 * n) - GrooveHeight(at - 1e-4 * n)) / 2e-4;
      const Eigen::Vector2d& t = section.tangents[i];
      points[i].tangent =
          rotation * Eigen::Vector3d(t.x() * n.x(), t.x() * n.y(), t.y() + slope * t.x());
    }
    return points;
  };
  return SweepClosed(ring, outline_.ArcLengthParameters(kRings), fineness);
}

TriangleMesh RimShape::UpperMesh(double from_deg, double to_deg,
                                 const MeshFineness& fineness) const {
  const double from = ParameterAtAngle(from_deg + 360) - 1, to = ParameterAtAngle(to_deg);
  const VolumeMap map = [&](double v, double q, double w) -> Eigen::Vector3d {
    const double s = from + v * (to - from);
    return Point(s, (1 + q) / 2 * Width(s), w * rim_.depth_mm / 2);
  };
  BarShape shape;
  shape.section = Superellipse(32, 4.0);
  shape.rings = kRings / 2;
  shape.dome_rings = 8;
  shape.fineness = fineness;
  return SweepBar(map, shape);
}

Eigen::Vector3d MirroredX(const Eigen::Vector3d& p) { return {-p.x(), p.y(), p.z()}; }

TriangleMesh MirroredX(const TriangleMesh& mesh) {
  TriangleMesh mirrored = mesh;
  for (Eigen::Vector3d& p : mirrored.positions) p.x() = -p.x();
  for (Eigen::Vector3d& n : mirrored.normals) n.x() = -n.x();
  for (Eigen::Vector3i& t : mirrored.triangles) std::swap(t[1], t[2]);
  return mirrored;
}

LensOpening MirroredX(const LensOpening& opening) {
  LensOpening mirrored;
  const Eigen::DiagonalMatrix<double, 3> flip(-1, 1, 1);
  mirrored.frame_from_opening.linear() = flip * opening.frame_from_opening.linear() * flip;
  mirrored.frame_from_opening.translation() = flip * opening.frame_from_opening.translation();
  const auto reflect = [](const Polygon2& polygon) {
    Polygon2 result(polygon.rbegin(), polygon.rend());
    for (Eigen::Vector2d& p : result) p.x() = -p.x();
    return result;
  };
  mirrored.contour_mm = reflect(opening.contour_mm);
  mirrored.aperture_mm = reflect(opening.aperture_mm);
  mirrored.groove_height_mm.assign(opening.groove_height_mm.rbegin(),
                                   opening.groove_height_mm.rend());
  return mirrored;
}

}  // namespace lorgnette
