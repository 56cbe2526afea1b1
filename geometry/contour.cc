// SPDX-License-Identifier: Apache-2.0
#include "geometry/contour.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/linear_algebra.h"
#include "base/units.h"
#include "geometry/closed_curve.h"
#include "geometry/silhouette.h"

namespace lorgnette {
namespace {

constexpr double kToolingPower = 530;  // D * mm: 1000 (1.530 - 1)
constexpr int kPlaneRounds = 4;
constexpr double kEdgeDepth_mm = 0.15;    // points so near to a lens' outermost one are of its edge
constexpr double kHollowSearch_mm = 2.5;  // a groove lies at most this far behind the lip
constexpr double kWallDepth_mm = 0.3;     // points so near to a rim's nearest one are of its wall

// Cuts of the mesh by one half-plane through the axis: segments in (distance from axis, height).
using Profile = std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>;

// What one direction found.
struct Feeler {
  double lip = kInfinity, lip_height = 0;  // nearest point of the rim
  double groove = kInfinity, groove_height = 0;
};

std::vector<Profile> CutByHalfPlanes(const TriangleMesh& mesh,
                                     const Eigen::Isometry3d& axis_from_frame, int count,
                                     double search_mm) {
  std::vector<Profile> profiles(static_cast<std::size_t>(count));
  std::vector<Eigen::Vector3d> p(mesh.positions.size());
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = axis_from_frame * mesh.positions[i];
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d* v[3] = {&p[std::size_t(t[0])], &p[std::size_t(t[1])],
                                   &p[std::size_t(t[2])]};
    // Edges short against their distance from the axis: the triangle spans the angles between its
    // vertices, taken relative to the first.
    const double first = std::atan2(v[0]->y(), v[0]->x());
    double low = 0, high = 0;
    bool near = false;
    for (const Eigen::Vector3d* q : v) {
      const double away = std::remainder(std::atan2(q->y(), q->x()) - first, 2 * kPi);
      low = std::min(low, away);
      high = std::max(high, away);
      near = near || q->head<2>().norm() < search_mm;
    }
    if (!near) continue;
    if (high - low > kPi) {  // around the axis: every direction may cut it
      low = -kPi;
      high = kPi;
    }
    const int from = int(std::ceil((first + low) / (2 * kPi) * count - 1e-9));
    const int to = int(std::floor((first + high) / (2 * kPi) * count + 1e-9));
    for (int k = from; k <= to; ++k) {
      const double angle = 2 * kPi * k / count;
      const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
      const Eigen::Vector2d across(-along.y(), along.x());
      Eigen::Vector2d ends[3];
      int found = 0;
      for (int e = 0; e < 3; ++e) {
        const Eigen::Vector3d &a = *v[e], &b = *v[(e + 1) % 3];
        const double da = across.dot(a.head<2>()), db = across.dot(b.head<2>());
        if ((da < 0) == (db < 0)) continue;
        const Eigen::Vector3d at = a + da / (da - db) * (b - a);
        ends[found++] = {along.dot(at.head<2>()), at.z()};
      }
      if (found != 2 || std::max(ends[0].x(), ends[1].x()) < 0) continue;
      profiles[std::size_t(((k % count) + count) % count)].push_back({ends[0], ends[1]});
    }
  }
  return profiles;
}

// The rim's inner side as the axis sees it: (height, distance) of the profile's points that no
// other segment hides, by ascending height.
std::vector<Eigen::Vector2d> VisibleSide(const Profile& profile, double lip) {
  std::vector<Eigen::Vector2d> points;
  for (const auto& [a, b] : profile) {
    for (const Eigen::Vector2d& p : {a, b}) {
      if (p.x() > lip + kHollowSearch_mm) continue;
      bool hidden = false;
      for (const auto& [c, d] : profile) {
        const double rise = d.y() - c.y();
        if ((c.y() - p.y()) * (d.y() - p.y()) > 0 || std::abs(rise) < 1e-12) continue;
        const double x = c.x() + (p.y() - c.y()) / rise * (d.x() - c.x());
        if (x < p.x() - 1e-7) {
          hidden = true;
          break;
        }
      }
      if (!hidden) points.push_back({p.y(), p.x()});
    }
  }
  std::sort(points.begin(), points.end(),
            [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() < b.x(); });
  return points;
}

// A lens in place of a rim: its outermost points, at the middle of the edge's height.
Feeler FeelOutside(const Profile& profile) {
  double reach = -kInfinity;
  for (const auto& [a, b] : profile) reach = std::max({reach, a.x(), b.x()});
  Feeler feeler;
  if (reach <= 0) return feeler;
  double low = kInfinity, high = -kInfinity;
  for (const auto& [a, b] : profile) {
    for (const Eigen::Vector2d& p : {a, b}) {
      if (p.x() < reach - kEdgeDepth_mm) continue;
      low = std::min(low, p.y());
      high = std::max(high, p.y());
    }
  }
  feeler.lip = feeler.groove = reach;
  feeler.lip_height = feeler.groove_height = (low + high) / 2;
  return feeler;
}

// The middle height of the wall that a rim without a groove turns to the axis: its nearest point
// alone would be anywhere along a flat wall, and at the wall's front or back end under an axis that
// is a little oblique.
double WallMiddle(const Profile& profile, const Feeler& feeler) {
  const double limit = feeler.lip + kWallDepth_mm;
  std::vector<std::pair<double, double>> spans;  // of heights, low and high
  for (const auto& [a, b] : profile) {
    if (std::min(a.x(), b.x()) > limit) continue;
    const auto within = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& from) {
      if (p.x() <= limit) return p.y();
      return from.y() + (limit - from.x()) / (p.x() - from.x()) * (p.y() - from.y());
    };
    spans.push_back(std::minmax(within(a, b), within(b, a)));
  }
  // Those that hang together with the nearest point.
  double low = feeler.lip_height, high = low;
  for (bool grown = true; grown;) {
    grown = false;
    for (const auto& [from, to] : spans) {
      if (from > high + kWallDepth_mm || to < low - kWallDepth_mm) continue;
      if (from >= low && to <= high) continue;
      low = std::min(low, from);
      high = std::max(high, to);
      grown = true;
    }
  }
  return (low + high) / 2;
}

Feeler Feel(const Profile& profile, double min_groove_mm) {
  Feeler feeler;
  for (const auto& [a, b] : profile) {
    for (const Eigen::Vector2d& p : {a, b}) {
      if (p.x() < feeler.lip) {
        feeler.lip = p.x();
        feeler.lip_height = p.y();
      }
    }
  }
  if (feeler.lip == kInfinity) return feeler;
  feeler.groove = feeler.lip;
  feeler.groove_height = WallMiddle(profile, feeler);
  // The deepest hollow between a nearer point below and a nearer point above.
  const std::vector<Eigen::Vector2d> side = VisibleSide(profile, feeler.lip);
  std::vector<double> above(side.size() + 1, kInfinity);
  for (std::size_t i = side.size(); i-- > 0;) above[i] = std::min(above[i + 1], side[i].y());
  double below = kInfinity, deepest = min_groove_mm;
  for (std::size_t i = 0; i < side.size(); ++i) {
    const double depth = side[i].y() - std::max(below, above[i + 1]);
    if (depth > deepest) {
      deepest = depth;
      feeler.groove = side[i].y();
      feeler.groove_height = side[i].x();
    }
    below = std::min(below, side[i].y());
  }
  return feeler;
}

// z = a + b x + c y + d (x^2 + y^2) through the groove: the plane's tilt free of the frame curve.
Eigen::Vector4d FitCurvedPlane(const std::vector<Eigen::Vector3d>& points) {
  Eigen::MatrixXd system(Eigen::Index(points.size()), 4);
  Eigen::VectorXd right(Eigen::Index(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d& p = points[i];
    system.row(Eigen::Index(i)) << 1, p.x(), p.y(), p.head<2>().squaredNorm();
    right[Eigen::Index(i)] = p.z();
  }
  // On a circular rim the curve cannot be told from the height: the least solution leaves d at 0.
  return LeastSquares(system, right);
}

struct Trace {
  Polygon2 contour, aperture;
  std::vector<double> height;  // of the groove, over the axis' origin
};

enum class Traced { kRim, kLens };

Result<Trace> TraceAround(const TriangleMesh& front, const Eigen::Isometry3d& frame_from_axis,
                          Traced traced, const ContourOptions& options) {
  const std::vector<Profile> profiles =
      CutByHalfPlanes(front, frame_from_axis.inverse(), options.points, options.search_mm);
  Trace trace;
  for (int k = 0; k < options.points; ++k) {
    const Profile& profile = profiles[std::size_t(k)];
    const Feeler feeler =
        traced == Traced::kRim ? Feel(profile, options.min_groove_mm) : FeelOutside(profile);
    const double degrees = 360.0 * k / options.points;
    if (!(feeler.lip < options.search_mm)) {
      return Failure("frame: no closed rim: got nothing at " +
                     std::to_string(int(std::lround(degrees))) + " degrees around an opening");
    }
    if (feeler.lip <= 0.5) return Failure("frame: the opening's middle is covered");
    const double angle = RadiansFromDegrees(degrees);
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    trace.contour.push_back(feeler.groove * along);
    trace.aperture.push_back(feeler.lip * along);
    trace.height.push_back(feeler.groove_height);
  }
  return trace;
}

// Heights of the trace carried over to the smooth contour by direction from the origin.
double HeightAlong(const Trace& trace, const Eigen::Vector2d& p) {
  const int n = int(trace.height.size());
  double k = std::atan2(p.y(), p.x()) / (2 * kPi) * n;
  if (k < 0) k += n;
  const int i = int(k) % n;
  const double u = k - std::floor(k);
  return (1 - u) * trace.height[std::size_t(i)] + u * trace.height[std::size_t((i + 1) % n)];
}

Polygon2 Smooth(const Polygon2& polygon, const ContourOptions& options) {
  const ClosedSpline spline = FitClosedSpline(polygon, options.spline_pieces);
  return spline.Sample(spline.ArcLengthParameters(options.points));
}

Eigen::Vector2d BoxCentre(const Polygon2& polygon) {
  Eigen::Vector2d low = polygon.front(), high = low;
  for (const Eigen::Vector2d& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (low + high) / 2;
}

double CurveOf(const LensOpening& opening) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < opening.contour_mm.size(); ++i) {
    const Eigen::Vector2d& p = opening.contour_mm[i];
    points.emplace_back(p.x(), p.y(), opening.groove_height_mm[i]);
  }
  const double d = -2 * FitCurvedPlane(points)[3];  // vertex curvature
  return kToolingPower * d;
}

}  // namespace

namespace {

Result<LensOpening> TraceShape(const TriangleMesh& front, const Eigen::Isometry3d& frame_from_axis,
                               Traced traced, const ContourOptions& options) {
  Eigen::Isometry3d frame_from_opening = frame_from_axis;
  Trace trace;
  for (int round = 0; round <= kPlaneRounds; ++round) {
    LG_ASSIGN(trace, TraceAround(front, frame_from_opening, traced, options));
    if (round == kPlaneRounds) break;
    const Eigen::Vector2d centre = BoxCentre(Smooth(trace.contour, options));
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < trace.contour.size(); ++i) {
      const Eigen::Vector2d p = trace.contour[i] - centre;
      points.emplace_back(p.x(), p.y(), trace.height[i]);
    }
    const Eigen::Vector4d plane = FitCurvedPlane(points);
    double mean = 0;
    for (const Eigen::Vector3d& p : points) mean += p.z() / double(points.size());
    const Eigen::Vector3d normal = Eigen::Vector3d(-plane[1], -plane[2], 1).normalized();
    frame_from_opening = frame_from_opening * Eigen::Translation3d(centre.x(), centre.y(), mean) *
                         ShortestTurn(Eigen::Vector3d::UnitZ(), normal);
  }
  // Turn about the axis so that +x stays level: the opening's x axis has no y in the frame.
  const Eigen::Vector3d z = frame_from_opening.linear().col(2);
  const Eigen::Vector3d x = Eigen::Vector3d::UnitY().cross(z).normalized();
  Eigen::Matrix3d level;
  level << x, z.cross(x), z;
  const Eigen::Matrix3d turn = level.transpose() * frame_from_opening.linear();
  const Eigen::Matrix2d turn2 = turn.topLeftCorner<2, 2>();
  const Polygon2 smooth = Smooth(trace.contour, options);

  LensOpening opening;
  double mean = 0;
  for (const Eigen::Vector2d& p : smooth) {
    opening.groove_height_mm.push_back(HeightAlong(trace, p));
    mean += opening.groove_height_mm.back() / double(smooth.size());
    opening.contour_mm.push_back(turn2 * p);
  }
  for (const Eigen::Vector2d& p : Smooth(trace.aperture, options)) {
    opening.aperture_mm.push_back(turn2 * p);
  }
  const Eigen::Vector2d centre = BoxCentre(opening.contour_mm);
  for (Eigen::Vector2d& p : opening.contour_mm) p -= centre;
  for (Eigen::Vector2d& p : opening.aperture_mm) p -= centre;
  for (double& h : opening.groove_height_mm) h -= mean;
  opening.frame_from_opening.linear() = level;
  opening.frame_from_opening.translation() =
      frame_from_opening.translation() + level * Eigen::Vector3d(centre.x(), centre.y(), mean);
  return opening;
}

Eigen::Isometry3d AxisThrough(const Eigen::Vector2d& p) {
  return Eigen::Isometry3d(Eigen::Translation3d(p.x(), p.y(), 0));
}

// Boxing, face form and curve of two openings that are traced.
void Summarise(TracedOpenings& traced) {
  const Boxing right = MeasureContour(traced.right.contour_mm);
  const Boxing left = MeasureContour(traced.left.contour_mm);
  traced.boxing.a_mm = (right.a_mm + left.a_mm) / 2;
  traced.boxing.b_mm = (right.b_mm + left.b_mm) / 2;
  traced.boxing.effective_diameter_mm =
      (right.effective_diameter_mm + left.effective_diameter_mm) / 2;
  traced.boxing.circumference_mm = (right.circumference_mm + left.circumference_mm) / 2;
  traced.boxing.dbl_mm =
      (traced.left.frame_from_opening.translation() - traced.right.frame_from_opening.translation())
          .x() -
      traced.boxing.a_mm;
  const auto turn = [](const LensOpening& o) {
    const Eigen::Vector3d axis = o.frame_from_opening.linear().col(2);
    return DegreesFromRadians(std::atan2(axis.x(), axis.z()));
  };
  traced.face_form_deg = (turn(traced.left) - turn(traced.right)) / 2;
  traced.frame_curve_diopters = (CurveOf(traced.right) + CurveOf(traced.left)) / 2;
}

}  // namespace

Result<LensOpening> TraceOpening(const TriangleMesh& front,
                                 const Eigen::Isometry3d& frame_from_axis,
                                 const ContourOptions& options) {
  return TraceShape(front, frame_from_axis, Traced::kRim, options);
}

Result<TracedOpenings> TraceOpenings(const TriangleMesh& front, const ContourOptions& options) {
  if (front.empty()) return Failure("frame: no closed rim: the front has no triangles");
  std::vector<SilhouetteRegion> holes = SilhouetteHoles(front);
  std::erase_if(holes,
                [&](const SilhouetteRegion& h) { return h.area_mm2 < options.min_area_mm2; });
  if (holes.size() < 2) {
    return Failure("frame: no closed rim: got " + std::to_string(holes.size()) +
                   " openings seen from the front, want 2");
  }
  if (holes[0].centre.x() > holes[1].centre.x()) std::swap(holes[0], holes[1]);
  TracedOpenings traced;
  LG_ASSIGN(traced.right, TraceOpening(front, AxisThrough(holes[0].centre), options));
  LG_ASSIGN(traced.left, TraceOpening(front, AxisThrough(holes[1].centre), options));
  Summarise(traced);
  return traced;
}

Result<TracedOpenings> TraceLenses(const TriangleMesh& lenses, const ContourOptions& options) {
  std::vector<SilhouetteRegion> discs = SilhouetteDiscs(lenses);
  std::erase_if(discs,
                [&](const SilhouetteRegion& d) { return d.area_mm2 < options.min_area_mm2; });
  if (discs.size() != 2) {
    return Failure("frame: got " + std::to_string(discs.size()) +
                   " lenses seen from the front, want 2");
  }
  if (discs[0].centre.x() > discs[1].centre.x()) std::swap(discs[0], discs[1]);
  TracedOpenings traced;
  const auto trace = [&](const SilhouetteRegion& disc) {
    TriangleMesh one = lenses;
    std::erase_if(one.triangles, [&](const Eigen::Vector3i& t) {
      Eigen::Vector3d middle(0, 0, 0);
      for (int k = 0; k < 3; ++k) middle += lenses.positions[std::size_t(t[k])] / 3;
      const Eigen::Vector2d p = middle.head<2>();
      return (p.array() < disc.low.array() - 1).any() || (p.array() > disc.high.array() + 1).any();
    });
    return TraceShape(one, AxisThrough(disc.centre), Traced::kLens, options);
  };
  LG_ASSIGN(traced.right, trace(discs[0]));
  LG_ASSIGN(traced.left, trace(discs[1]));
  Summarise(traced);
  return traced;
}

double RimShare(const TriangleMesh& front, const LensOpening& opening) {
  constexpr int kDirections = 120;
  constexpr double kInside_mm = 1.5, kOutside_mm = 2.5;  // of the contour: where a rim may be
  const std::vector<Profile> profiles =
      CutByHalfPlanes(front, opening.frame_from_opening.inverse(), kDirections,
                      ContourOptions{}.search_mm + kOutside_mm);
  int covered = 0;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2 * kPi * k / kDirections;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    double reach = 0;  // of the contour in this direction
    for (const Eigen::Vector2d& p : opening.contour_mm) {
      if (p.dot(along) > 0 && std::abs(p.x() * along.y() - p.y() * along.x()) < 0.5) {
        reach = std::max(reach, p.dot(along));
      }
    }
    const auto& profile = profiles[std::size_t(k)];
    covered += std::any_of(profile.begin(), profile.end(), [&](const auto& segment) {
      const auto [near, far] = std::minmax(segment.first.x(), segment.second.x());
      return far > reach - kInside_mm && near < reach + kOutside_mm;
    });
  }
  return double(covered) / kDirections;
}

TriangleMesh PartsOfKind(const FrameModel& frame, FramePartKind kind) {
  TriangleMesh mesh;
  for (const FramePart& part : frame.parts) {
    if (part.kind == kind) Append(mesh, part.mesh);
  }
  return mesh;
}

}  // namespace lorgnette
