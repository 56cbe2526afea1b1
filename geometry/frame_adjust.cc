// SPDX-License-Identifier: Apache-2.0
#include "geometry/frame_adjust.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "geometry/face_relief.h"

namespace lorgnette {
namespace {

bool OnRight(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Eigen::Vector3d& p : mesh.positions) sum += p.x();
  return sum < 0;
}

struct PlaneHit {
  double distance;          // along head z from the pupil
  Eigen::Vector3d opening;  // the point, opening coordinates (z = 0)
};
PlaneHit LookThrough(const LensOpening& opening, const Eigen::Isometry3d& head_from_frame,
                     const Eigen::Vector3d& pupil) {
  const Eigen::Isometry3d head_from_opening = head_from_frame * opening.frame_from_opening;
  const Eigen::Vector3d axis = head_from_opening.linear().col(2);
  const double distance = axis.dot(head_from_opening.translation() - pupil) / axis.z();
  return {distance, head_from_opening.inverse() * (pupil + distance * Eigen::Vector3d::UnitZ())};
}

}  // namespace

void ShiftPads(FrameModel& frame, double shift_mm) {
  for (FramePart& part : frame.parts) {
    const bool pad = part.kind == FramePartKind::kNosePad;
    if (!pad && part.name.find("pad arm") == std::string::npos) continue;
    const double outward = OnRight(part.mesh) ? -shift_mm : shift_mm;
    double back = std::numeric_limits<double>::infinity(), front = -back;
    for (const Eigen::Vector3d& p : part.mesh.positions) {
      back = std::min(back, p.z());
      front = std::max(front, p.z());
    }
    for (Eigen::Vector3d& p : part.mesh.positions) {
      p.x() += outward * (pad || front <= back ? 1.0 : (front - p.z()) / (front - back));
    }
    if (!pad) ComputeVertexNormals(part.mesh);
  }
  for (Eigen::Vector3d& p : frame.nose_contacts) p.x() += std::copysign(shift_mm, p.x());
}

double SwingTemple(FrameModel& frame, bool right, const Eigen::Vector3d& ear, double most_deg) {
  const double side = right ? -1 : 1;
  Eigen::Vector3d hinge(0, 0, -std::numeric_limits<double>::infinity());
  for (const FramePart& part : frame.parts) {
    if (part.kind != FramePartKind::kTemple || OnRight(part.mesh) != right) continue;
    for (const Eigen::Vector3d& p : part.mesh.positions) {
      if (p.z() > hinge.z()) hinge = p;
    }
  }
  if (!std::isfinite(hinge.z())) return 0;
  Eigen::Vector3d& rest = right ? frame.ear_point_right : frame.ear_point_left;
  // Inner face of the temple at the bend, as the frame is made.
  const Eigen::Vector2d made(side * frame.temple_spread_mm / 2 - hinge.x(), rest.z() - hinge.z());
  const Eigen::Vector2d wanted(ear.x() - hinge.x(), ear.z() - hinge.z());
  const auto outward = [&](const Eigen::Vector2d& v) { return std::atan2(side * v.x(), -v.y()); };
  const double most = RadiansFromDegrees(most_deg);
  const double swing = std::clamp(outward(wanted) - outward(made), -most, most);
  // Outward on the left moves the end toward +x: a turn about +y by a negative angle, as -z goes
  // to +x then.
  const Eigen::AngleAxisd turn(-side * swing, Eigen::Vector3d::UnitY());
  const auto move = [&](Eigen::Vector3d& p) { p = hinge + turn * (p - hinge); };
  for (FramePart& part : frame.parts) {
    if (part.kind != FramePartKind::kTemple || OnRight(part.mesh) != right) continue;
    for (Eigen::Vector3d& p : part.mesh.positions) move(p);
    for (Eigen::Vector3d& n : part.mesh.normals) n = turn * n;
  }
  move(rest);
  return DegreesFromRadians(swing);
}

double BowTemple(FrameModel& frame, bool right, const Eigen::Isometry3d& head_from_frame,
                 const TriangleMesh& head, double most_mm) {
  constexpr double kClearance_mm = 0.5;
  constexpr double kEndShare = 0.06;  // no bow helps nearer to the ends than this
  const double side = right ? -1 : 1;
  // The head from the side: its height map along x, over (z, y).
  TriangleMesh turned;
  turned.triangles = head.triangles;
  for (const Eigen::Vector3d& p : head.positions) {
    turned.positions.emplace_back(p.z(), p.y(), side * p.x());
  }
  const FaceRelief profile(turned, 1.0, 110, 20);
  const Eigen::Vector3d& rest = right ? frame.ear_point_right : frame.ear_point_left;
  double front = -std::numeric_limits<double>::infinity();
  for (const FramePart& part : frame.parts) {
    if (part.kind != FramePartKind::kTemple || OnRight(part.mesh) != right) continue;
    for (const Eigen::Vector3d& p : part.mesh.positions) front = std::max(front, p.z());
  }
  const double length = front - rest.z();
  if (!(length > 0)) return 0;
  const auto share = [&](double z) { return (front - z) / length; };  // 0 hinge, 1 bend
  double bow = 0;
  for (const FramePart& part : frame.parts) {
    if (part.kind != FramePartKind::kTemple || OnRight(part.mesh) != right) continue;
    for (const Eigen::Vector3d& p : part.mesh.positions) {
      const double u = share(p.z());
      if (u < kEndShare || u > 1 - kEndShare) continue;
      const Eigen::Vector3d at = head_from_frame * p;
      if (const auto skin = profile.Height(at.z(), at.y())) {
        bow = std::max(bow, (*skin + kClearance_mm - side * at.x()) / (4 * u * (1 - u)));
      }
    }
  }
  bow = std::min(bow, most_mm);
  if (bow <= 0) return 0;
  for (FramePart& part : frame.parts) {
    if (part.kind != FramePartKind::kTemple || OnRight(part.mesh) != right) continue;
    for (std::size_t i = 0; i < part.mesh.positions.size(); ++i) {
      Eigen::Vector3d& p = part.mesh.positions[i];
      const double u = share(p.z());
      if (u <= 0 || u >= 1) continue;
      p.x() += side * bow * 4 * u * (1 - u);
      // x gains g(z): a normal gains -g'(z) times its x along z.
      const double slope = side * bow * 4 * (1 - 2 * u) * (-1 / length);
      Eigen::Vector3d& n = part.mesh.normals[i];
      n.z() -= slope * n.x();
      n.normalize();
    }
  }
  return bow;
}

Eigen::Vector2d PupilInOpening(const LensOpening& opening, const Eigen::Isometry3d& head_from_frame,
                               const Eigen::Vector3d& pupil) {
  return LookThrough(opening, head_from_frame, pupil).opening.head<2>();
}

void MeasureWearing(const FrameModel& frame, const Eigen::Isometry3d& head_from_frame,
                    const Eigen::Vector3d& pupil_right, const Eigen::Vector3d& pupil_left,
                    double lens_depth_mm, WearingPosition& wearing) {
  const PlaneHit right = LookThrough(frame.right, head_from_frame, pupil_right);
  const PlaneHit left = LookThrough(frame.left, head_from_frame, pupil_left);
  wearing.vertex_distance_right_mm = right.distance - lens_depth_mm;
  wearing.vertex_distance_left_mm = left.distance - lens_depth_mm;
  wearing.fitting_height_right_mm = right.opening.y();
  wearing.fitting_height_left_mm = left.opening.y();
  const auto turn = [&](const LensOpening& opening) {
    const Eigen::Vector3d axis = opening.frame_from_opening.linear().col(2);
    return DegreesFromRadians(std::atan2(axis.x(), axis.z()));
  };
  wearing.face_form_deg = (turn(frame.left) - turn(frame.right)) / 2;
}

}  // namespace lorgnette
