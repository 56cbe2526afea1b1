// SPDX-License-Identifier: Apache-2.0
#include "geometry/frame_limbs.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace lorgnette {
namespace {

double Smoothstep(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}
double Mix(double a, double b, double t) { return a + t * (b - a); }

Eigen::Vector3d Bezier(const Eigen::Vector3d (&p)[4], double t) {
  const double u = 1 - t;
  return u * u * u * p[0] + 3 * u * u * t * p[1] + 3 * u * t * t * p[2] + t * t * t * p[3];
}
Eigen::Vector3d BezierDerivative(const Eigen::Vector3d (&p)[4], double t) {
  const double u = 1 - t;
  return 3 * (u * u * (p[1] - p[0]) + 2 * u * t * (p[2] - p[1]) + t * t * (p[3] - p[2]));
}

// A direction across the curve at equal steps of its parameter, carried along without twist.
std::vector<Eigen::Vector3d> UntwistedSides(const Eigen::Vector3d (&path)[4]) {
  constexpr int kSteps = 96;
  std::vector<Eigen::Vector3d> sides;
  Eigen::Vector3d side = BezierDerivative(path, 0).unitOrthogonal();
  for (int k = 0; k <= kSteps; ++k) {
    const Eigen::Vector3d t = BezierDerivative(path, double(k) / kSteps).normalized();
    side = (side - side.dot(t) * t).normalized();
    sides.push_back(side);
  }
  return sides;
}

// The middle line of a temple in its own upright plane: distance back and height below the hinge's
// level line, by arc length, with the direction of travel.
class TempleLine {
 public:
  TempleLine(const TempleParameters& temple, double tilt_deg)
      : temple_(temple), tilt_(RadiansFromDegrees(tilt_deg)) {
    back_.push_back({0, 0});
    for (int k = 0; k < kSteps; ++k) {
      const double pitch = Pitch((k + 0.5) * temple.length_mm / kSteps);
      back_.push_back(back_.back() + temple.length_mm / kSteps *
                                         Eigen::Vector2d(std::cos(pitch), std::sin(pitch)));
    }
  }
  // Downward angle at arc length l: the tilt, then the bend around the ear.
  double Pitch(double l) const {
    constexpr double kBendLength_mm = 30;
    const double bend =
        Smoothstep((l - temple_.to_bend_mm + 0.3 * kBendLength_mm) / kBendLength_mm);
    return tilt_ + RadiansFromDegrees(temple_.bend_deg) * bend;
  }
  // (back, down) at arc length l.
  Eigen::Vector2d At(double l) const {
    const double k = std::clamp(l / temple_.length_mm, 0.0, 1.0) * kSteps;
    const std::size_t i = std::min(std::size_t(k), std::size_t(kSteps - 1));
    return back_[i] + (k - double(i)) * (back_[i + 1] - back_[i]);
  }

 private:
  static constexpr int kSteps = 600;
  TempleParameters temple_;
  double tilt_;
  std::vector<Eigen::Vector2d> back_;
};

}  // namespace

TriangleMesh BridgeMesh(const RimShape& rim, const RimParameters& rim_parameters,
                        const BridgeParameters& bridge, const MeshFineness& fineness) {
  const double s_top = rim.ParameterAtAngle(bridge.attach_top_deg);
  double s_bottom = rim.ParameterAtAngle(bridge.attach_bottom_deg);
  if (s_bottom < s_top) s_bottom += 1;
  const VolumeMap map = [&](double v, double q, double w) {
    const double t = 2 * v - 1;
    const double s = Mix(s_bottom, s_top, (q + 1) / 2);
    const Eigen::Vector3d attach = rim.Point(s, 0.55 * rim.Width(s), 0);
    const double middle = 1 - std::pow(t * t, 1.25);  // 1 in the middle, 0 at the rims
    const double rise = Mix(bridge.rise_bottom_mm, bridge.rise_top_mm, (q + 1) / 2);
    const double depth = Mix(0.92 * rim_parameters.depth_mm, bridge.depth_mm, middle);
    return Eigen::Vector3d(t * attach.x(), attach.y() + rise * middle,
                           attach.z() + bridge.forward_mm * middle + w * depth / 2);
  };
  BarShape shape;
  shape.section = Superellipse(40, 3.0);
  shape.rings = 48;
  shape.dome_rings = 8;
  shape.dome_start = shape.dome_end = 0.03;
  shape.fineness = fineness;
  return SweepBar(map, shape);
}

Pad PadMesh(const RimShape& rim, const RimParameters& rim_parameters, const PadParameters& pad,
            const MeshFineness& fineness) {
  // The face looks to the nose: inward, downward and backward.
  const double frontal = RadiansFromDegrees(pad.frontal_deg);
  const double splay = RadiansFromDegrees(pad.splay_deg);
  const Eigen::Vector3d up(-std::sin(frontal), std::cos(frontal), 0);
  const Eigen::Vector3d back(std::sin(splay), 0, -std::cos(splay));
  const Eigen::Vector3d face = up.cross(back).normalized();  // x < 0
  const Eigen::Vector3d along = up.normalized();
  const Eigen::Vector3d across = along.cross(face);
  const Eigen::Vector3d face_centre(pad.half_gap_mm, pad.y_mm, pad.z_mm);
  const Eigen::Vector3d centre = face_centre - face * (pad.thickness_mm / 2);

  // On an arm: a cushion. Without: a fin that runs out of the rim's nasal side into the face.
  const double s_top = rim.ParameterAtAngle(158), s_bottom = rim.ParameterAtAngle(203);
  const VolumeMap map = [&](double v, double q, double w) -> Eigen::Vector3d {
    const double l = (v - 0.5) * pad.height_mm;
    const Eigen::Vector3d cushion =
        centre + l * along + q * pad.width_mm / 2 * across + w * pad.thickness_mm / 2 * face;
    if (pad.arm_mm > 0) return cushion;
    const double s = Mix(s_bottom, s_top, v);
    const Eigen::Vector3d root =
        rim.Point(s, 0.2 * rim.Width(s), (0.3 * q - 0.2) * rim_parameters.depth_mm);
    return root + 0.5 * (1 + w) * (cushion - root);
  };
  BarShape shape;
  shape.section = Superellipse(28, 2.4);
  shape.rings = 10;
  shape.dome_rings = 8;
  shape.dome_start = shape.dome_end = 0.4;
  Pad result;
  const TriangleMesh fine = SweepBar(map, shape);
  for (std::size_t i = 0; i < fine.positions.size(); ++i) {
    if (fine.normals[i].dot(face) > 0.7) result.contacts.push_back(fine.positions[i]);
  }
  shape.fineness = fineness;
  result.pad = SweepBar(map, shape);

  if (pad.arm_mm > 0) {
    const double s = rim.ParameterAtAngle(165);
    const Eigen::Vector3d start = rim.Point(s, 0.4 * rim.Width(s), -0.35 * rim_parameters.depth_mm);
    const Eigen::Vector3d end = centre - face * (0.2 * pad.thickness_mm);
    const double d = (end - start).norm();
    const Eigen::Vector3d path[4] = {start, start + d * Eigen::Vector3d(0.1, 0.1, -0.7),
                                     end + d * Eigen::Vector3d(0.4, 0.3, -0.5), end};
    const std::vector<Eigen::Vector3d> sides = UntwistedSides(path);
    const VolumeMap arm = [&](double v, double q, double w) -> Eigen::Vector3d {
      const Eigen::Vector3d t = BezierDerivative(path, v).normalized();
      const double k = std::clamp(v, 0.0, 1.0) * double(sides.size() - 1);
      const std::size_t i = std::min(std::size_t(k), sides.size() - 2);
      const Eigen::Vector3d side =
          Eigen::Vector3d(sides[i] + (k - double(i)) * (sides[i + 1] - sides[i]));
      const Eigen::Vector3d n1 = (side - side.dot(t) * t).normalized();
      return Bezier(path, v) + pad.arm_mm * (q * n1 + w * t.cross(n1));
    };
    BarShape wire;
    wire.section = Superellipse(14, 2);
    wire.rings = 28;
    wire.dome_rings = 4;
    wire.dome_start = wire.dome_end = 0.04;
    wire.fineness = fineness;
    result.arm = SweepBar(arm, wire);
  }
  return result;
}

EndPiece EndPieceMesh(const RimShape& rim, const RimParameters& rim_parameters,
                      const EndPieceParameters& end, double temple_thickness_mm,
                      const MeshFineness& fineness) {
  const double s = rim.ParameterAtAngle(end.angle_deg);
  const Eigen::Vector3d start = rim.Point(s, 0.45 * rim.Width(s), 0);
  const double x = rim.OuterReach() + end.reach_mm - end.thickness_mm / 2;
  EndPiece result;
  result.hinge = Eigen::Vector3d(x, start.y(), start.z() - end.back_mm);
  const Eigen::Vector3d corner(x, start.y(), start.z());
  const Eigen::Vector3d path[4] = {start, start + 0.85 * (corner - start),
                                   corner - Eigen::Vector3d(0, 0, 0.15 * end.back_mm),
                                   result.hinge};
  const double first_depth = std::max(0.9 * rim_parameters.depth_mm, end.thickness_mm);
  const VolumeMap map = [&](double v, double q, double w) -> Eigen::Vector3d {
    const Eigen::Vector3d t = BezierDerivative(path, v).normalized();
    const Eigen::Vector3d n = Eigen::Vector3d::UnitY().cross(t).normalized();
    const double depth = Mix(first_depth, temple_thickness_mm, Smoothstep(v));
    return Bezier(path, v) + q * end.height_mm / 2 * Eigen::Vector3d::UnitY() + w * depth / 2 * n;
  };
  BarShape shape;
  shape.section = Superellipse(32, 3.2);
  shape.rings = 36;
  shape.dome_rings = 4;
  shape.dome_start = shape.dome_end = 0.05;
  shape.fineness = fineness;
  result.mesh = SweepBar(map, shape);

  const double barrel = std::min(1.1, 0.35 * end.height_mm);
  const Eigen::Vector3d axis_centre =
      result.hinge - Eigen::Vector3d(temple_thickness_mm / 2 + 0.4 * barrel, 0, 0);
  const double barrel_height = std::min(4.5, 0.9 * end.height_mm);
  const VolumeMap cylinder = [&](double v, double q, double w) -> Eigen::Vector3d {
    return axis_centre + Eigen::Vector3d(q * barrel, (v - 0.5) * barrel_height, w * barrel);
  };
  BarShape round;
  round.section = Superellipse(20, 2);
  round.rings = 6;
  round.dome_rings = 3;
  round.dome_start = round.dome_end = 0.06;
  round.fineness = fineness;
  result.barrel = SweepBar(cylinder, round);
  return result;
}

Temple TempleMesh(const TempleParameters& temple, const Eigen::Vector3d& hinge,
                  double pantoscopic_tilt_deg, const MeshFineness& fineness) {
  const TempleLine line(temple, pantoscopic_tilt_deg);
  const double ear_x = temple.spread_mm / 2 + temple.thickness_mm / 2;
  const auto lateral = [&](double l) {
    const double toward_ear = Smoothstep(l / temple.to_bend_mm);
    const double past = std::max(0.0, l - temple.to_bend_mm);
    const double inward = std::tan(RadiansFromDegrees(temple.tip_inward_deg));
    return Mix(hinge.x(), ear_x, toward_ear) - inward * past * past / (past + 12);
  };
  const auto point = [&](double l) {
    const Eigen::Vector2d p = line.At(l);
    return Eigen::Vector3d(lateral(l), hinge.y() - p.y(), hinge.z() - p.x());
  };
  const auto height = [&](double l) {
    const double first =
        Mix(temple.height_mm, temple.middle_height_mm, Smoothstep(l / (0.65 * temple.to_bend_mm)));
    if (temple.tip_sleeve_mm > 0) return first;
    return Mix(first, temple.tip_height_mm,
               Smoothstep((l - 0.75 * temple.to_bend_mm) / (temple.length_mm - temple.to_bend_mm)));
  };
  // A bar along [from, to] of the line; h and thickness by arc length.
  const auto bar = [&](double from, double to, const auto& h, double thickness, int rings,
                       double first_dome_mm, double last_dome_mm) {
    const VolumeMap map = [&](double v, double q, double w) -> Eigen::Vector3d {
      const double l = Mix(from, to, v);
      const double pitch = line.Pitch(l);
      const Eigen::Vector3d up(0, std::cos(pitch), -std::sin(pitch));
      return point(l) + q * h(l) / 2 * up + w * thickness / 2 * Eigen::Vector3d::UnitX();
    };
    BarShape shape;
    shape.section = Superellipse(28, 2.8);
    shape.rings = rings;
    shape.dome_rings = 6;
    shape.dome_start = first_dome_mm / (to - from);
    shape.dome_end = last_dome_mm / (to - from);
    shape.fineness = fineness;
    return SweepBar(map, shape);
  };
  Temple result;
  const bool sleeved = temple.tip_sleeve_mm > 0;
  const double bar_end = sleeved ? temple.length_mm - 8 : temple.length_mm;
  result.bar = bar(0, bar_end, height, temple.thickness_mm, 80, 0.4,
                   sleeved ? 1.0 : 0.6 * temple.tip_height_mm);
  if (sleeved) {
    const double start = temple.length_mm - temple.tip_sleeve_mm;
    const auto tip = [&](double l) {
      return Mix(std::max(temple.middle_height_mm + 0.8, 0.6 * temple.tip_height_mm),
                 temple.tip_height_mm, Smoothstep((l - start) / temple.tip_sleeve_mm));
    };
    result.sleeve = bar(start, temple.length_mm, tip, temple.tip_thickness_mm, 48, 1.2,
                        0.6 * temple.tip_height_mm);
  }
  result.ear_point =
      point(temple.to_bend_mm) - Eigen::Vector3d(0, height(temple.to_bend_mm) / 2, 0);
  return result;
}

}  // namespace lorgnette
