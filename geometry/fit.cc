// SPDX-License-Identifier: Apache-2.0
#include "geometry/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <limits>

#include "base/units.h"
#include "geometry/face_relief.h"
#include "geometry/frame_adjust.h"
#include "geometry/parametric_frame.h"
#include "geometry/rim_shape.h"

namespace lorgnette {
namespace {

constexpr double kLowest_mm = -14, kHighest_mm = 8, kHeightStep_mm = 0.25;
constexpr double kTiltLeast_deg = 2, kTiltMost_deg = 16;
constexpr double kTiltBend_deg = 6;  // temples are bent no further than this from their make
constexpr double kSideSearch_mm = 3;
constexpr double kHeightWorth_mm = 1.0;  // of pupil height weighs as 1 mm of vertex distance
constexpr double kWidthNote_mm = 4;
constexpr double kSwingMost_deg = 8, kBowMost_mm = 8;
constexpr std::size_t kCanonicalVertices = 468, kRightSide = 234, kLeftSide = 454;
constexpr double kShiftStep_mm = 0.5;
constexpr double kShiftWorth = 0.02;     // of 1 mm^2 of pad shift: bend no more than it is worth
constexpr double kSizeWorth = 0.05;      // of 1 mm^2 of another bridge size
constexpr std::size_t kFrontStride = 3;  // of the front's vertices that are tested against the skin

// Frame points in frame coordinates that the skin must not pass.
struct Obstacles {
  std::vector<Eigen::Vector3d> contacts, front;
};

Eigen::Matrix3d TiltRotation(double tilt_deg) {
  return Eigen::AngleAxisd(RadiansFromDegrees(tilt_deg), Eigen::Vector3d::UnitX())
      .toRotationMatrix();
}

// z of the frame at which the first contact presses by kContactDepth_mm, or any other point of the
// front touches; for one side (sign of x in the frame) or both (0).
std::optional<double> RestingDepth(const Obstacles& points, const FaceRelief& relief,
                                   const Eigen::Matrix3d& rotation, double x, double y, int side) {
  double z = -std::numeric_limits<double>::infinity();
  for (const bool contact : {true, false}) {
    for (const Eigen::Vector3d& p : contact ? points.contacts : points.front) {
      if (side != 0 && p.x() * side < 0) continue;
      const Eigen::Vector3d at = rotation * p;
      const auto height = relief.Height(at.x() + x, at.y() + y);
      if (!height) continue;
      double allowed = 0;
      if (contact) {
        const auto normal = relief.Normal(at.x() + x, at.y() + y);
        if (normal) allowed = kContactDepth_mm / std::max(0.2, normal->z());
      }
      z = std::max(z, *height - at.z() - allowed);
    }
  }
  return std::isfinite(z) ? std::optional(z) : std::nullopt;
}

// Deepest point of pads, bridge and rim on one side, along the skin's normal, mm (negative: how far
// the nearest is above the skin).
double ContactDepth(const Obstacles& points, const FaceRelief& relief,
                    const Eigen::Isometry3d& head_from_frame, int side) {
  double deepest = -std::numeric_limits<double>::infinity();
  for (const auto* list : {&points.contacts, &points.front}) {
    for (const Eigen::Vector3d& p : *list) {
      if (p.x() * side < 0) continue;
      const Eigen::Vector3d at = head_from_frame * p;
      const auto height = relief.Height(at.x(), at.y());
      const auto normal = relief.Normal(at.x(), at.y());
      if (height && normal) deepest = std::max(deepest, (*height - at.z()) * normal->z());
    }
  }
  return deepest;
}

// Tilt that brings the temples' rests to the ears' height when the frame's origin is at height y.
double TiltByEars(const FrameModel& frame, const EarPoints& ears, double y, double z) {
  const Eigen::Vector3d rest = (MirroredX(frame.ear_point_right) + frame.ear_point_left) / 2;
  const Eigen::Vector3d ear = (MirroredX(ears.right) + ears.left) / 2;
  // The rest slides along the temple: only the direction from the origin to the ear counts, and
  // the height of the temple's line over the origin.
  const double slope = std::tan(RadiansFromDegrees(frame.pantoscopic_tilt_deg));
  const double line_height = rest.y() - slope * rest.z();  // of the temple's line at z = 0
  // In the frame the line is y = line_height + slope * z. Turned by t about x it passes the ear.
  const Eigen::Vector2d to_ear(ear.y() - y, ear.z() - z);
  double t = RadiansFromDegrees(frame.pantoscopic_tilt_deg);
  for (int step = 0; step < 20; ++step) {
    // The ear in the frame: [c s; -s c] applied to (y, z).
    const double c = std::cos(t), s = std::sin(t);
    const double ey = c * to_ear.x() + s * to_ear.y(), ez = -s * to_ear.x() + c * to_ear.y();
    t += (line_height + slope * ez - ey) / ez;
  }
  return DegreesFromRadians(t);
}

struct Candidate {
  double y = 0, z = 0, x = 0, tilt_deg = 0, cost = std::numeric_limits<double>::infinity();
  double vertex_mm = 0, pupil_height_mm = 0;
};

// One height on the nose: the tilt that the ears give there, and the depth at which rims and bridge
// stop. Neither depends on the pads.
struct HeightRow {
  double y = 0, tilt_deg = 0;
  std::optional<double> front_z;
};

class Fitter {
 public:
  Fitter(const FrameModel& frame, const FaceRelief& relief, const EarPoints& ears,
         const Eigen::Vector3d& pupil_right, const Eigen::Vector3d& pupil_left,
         const FitOptions& options)
      : frame_(frame), relief_(relief), ears_(ears), options_(options) {
    pupils_ = {pupil_right, pupil_left};
    points_.contacts = frame.nose_contacts;
    for (const FramePart& part : frame.parts) {
      if (part.kind != FramePartKind::kFront && part.kind != FramePartKind::kNosePad) continue;
      for (std::size_t i = 0; i < part.mesh.positions.size(); i += kFrontStride) {
        const Eigen::Vector3d& p = part.mesh.positions[i];
        const bool pad = part.kind == FramePartKind::kNosePad;
        if (!pad && p.z() < 0.5) points_.front.push_back(p);
      }
    }
    target_height_ =
        options.pupil_height_mm.value_or(std::clamp(0.09 * frame.boxing.b_mm, 2.0, 5.0));
    FindRows();
  }

  const Obstacles& points() const { return points_; }

  // Slides a candidate sideways until both sides press alike, and back until it touches.
  void Settle(Candidate& c) const {
    const Obstacles& points = points_;
    const Eigen::Matrix3d rotation = TiltRotation(c.tilt_deg);
    double low = -kSideSearch_mm, high = kSideSearch_mm;
    const auto difference = [&](double x) {
      const auto right = RestingDepth(points, relief_, rotation, x, c.y, -1);
      const auto left = RestingDepth(points, relief_, rotation, x, c.y, 1);
      return right && left ? *left - *right : 0.0;
    };
    // Moved toward the left (+x) the left side comes off the nose.
    if (difference(low) > 0 && difference(high) < 0) {
      for (int step = 0; step < 14; ++step) {
        const double middle = (low + high) / 2;
        (difference(middle) > 0 ? low : high) = middle;
      }
      c.x = (low + high) / 2;
    }
    if (const auto z = RestingDepth(points, relief_, rotation, c.x, c.y, 0)) c.z = *z;
    Price(c);
  }

  // The best height on the nose, in the middle of the face, for pads moved outward by `shift`.
  Candidate Best(double shift) const {
    const Obstacles moved = Moved(shift);
    Candidate best;
    for (const HeightRow& row : rows_) {
      const Eigen::Matrix3d rotation = TiltRotation(row.tilt_deg);
      const auto pads = RestingDepth({moved.contacts, {}}, relief_, rotation, 0, row.y, 0);
      if (!pads && !row.front_z) continue;
      Candidate c;
      c.y = row.y;
      c.tilt_deg = row.tilt_deg;
      c.z = std::max(pads.value_or(-kInfinity), row.front_z.value_or(-kInfinity));
      Price(c);
      if (c.cost < best.cost) best = c;
    }
    best.cost += kShiftWorth * shift * shift;
    return best;
  }

 private:
  Obstacles Moved(double shift) const {
    Obstacles moved = points_;
    for (Eigen::Vector3d& p : moved.contacts) p.x() += std::copysign(shift, p.x());
    return moved;
  }

  void FindRows() {
    for (double y = kLowest_mm; y <= kHighest_mm; y += kHeightStep_mm) {
      HeightRow row;
      row.y = y;
      double z = 14;
      for (int round = 0; round < 2; ++round) {
        row.tilt_deg = options_.tilt_deg.value_or(
            std::clamp(TiltByEars(frame_, ears_, y, z),
                       std::max(kTiltLeast_deg, frame_.pantoscopic_tilt_deg - kTiltBend_deg),
                       std::min(kTiltMost_deg, frame_.pantoscopic_tilt_deg + kTiltBend_deg)));
        const Eigen::Matrix3d rotation = TiltRotation(row.tilt_deg);
        if (round == 0) {
          z = RestingDepth({points_.contacts, {}}, relief_, rotation, 0, y, 0).value_or(z);
        } else {
          row.front_z = RestingDepth({{}, points_.front}, relief_, rotation, 0, y, 0);
        }
      }
      rows_.push_back(row);
    }
  }

  void Price(Candidate& c) const {
    c.vertex_mm = c.pupil_height_mm = 0;
    Measure(TiltRotation(c.tilt_deg), c);
    const double height_off = (c.pupil_height_mm - target_height_) / kHeightWorth_mm;
    const double vertex_off = c.vertex_mm < options_.min_vertex_mm
                                  ? options_.min_vertex_mm - c.vertex_mm
                                  : std::max(0.0, c.vertex_mm - options_.max_vertex_mm);
    c.cost = height_off * height_off + vertex_off * vertex_off;
  }

  void Measure(const Eigen::Matrix3d& rotation, Candidate& c) const {
    Eigen::Isometry3d head_from_frame = Eigen::Isometry3d::Identity();
    head_from_frame.linear() = rotation;
    head_from_frame.translation() << c.x, c.y, c.z;
    const LensOpening* openings[2] = {&frame_.right, &frame_.left};
    for (int k = 0; k < 2; ++k) {
      const Eigen::Isometry3d head_from_opening = head_from_frame * openings[k]->frame_from_opening;
      const Eigen::Vector3d axis = head_from_opening.linear().col(2);
      const Eigen::Vector3d& pupil = pupils_[std::size_t(k)];
      // Along the line of sight to the opening's plane.
      const double distance = axis.dot(head_from_opening.translation() - pupil) / axis.z();
      const Eigen::Vector3d at =
          head_from_opening.inverse() * (pupil + distance * Eigen::Vector3d::UnitZ());
      c.vertex_mm += (distance - options_.lens_depth_mm) / 2;
      c.pupil_height_mm += at.y() / 2;
    }
  }

  const FrameModel& frame_;
  const FaceRelief& relief_;
  const EarPoints& ears_;
  const FitOptions& options_;
  std::array<Eigen::Vector3d, 2> pupils_;
  Obstacles points_;
  double target_height_;
  std::vector<HeightRow> rows_;
};

bool HasPadArms(const FrameModel& frame) {
  return std::any_of(frame.parts.begin(), frame.parts.end(), [](const FramePart& part) {
    return part.name.find("pad arm") != std::string::npos;
  });
}

// How far pads may be moved outward and inward: bent on their arms, or filed and built up.
struct PadRange {
  double inward = 0, outward = 0;
};
PadRange PadRangeOf(const FrameModel& frame, const FitOptions& options) {
  if (!options.adapt_bridge) return {};
  if (HasPadArms(frame)) return {options.pad_travel_mm, options.pad_travel_mm};
  if (frame.parameters) return {options.pad_build_up_mm, options.pad_filing_mm};
  return {};
}

// The bridge sizes to try: the one the frame was loaded with first.
std::vector<double> SizesOf(const FrameModel& frame, const FitOptions& options) {
  std::vector<double> sizes = {frame.boxing.dbl_mm};
  if (options.adapt_bridge && frame.parameters) {
    for (const double size : frame.parameters->bridge_sizes_mm) {
      if (std::abs(size - sizes[0]) > 0.05) sizes.push_back(size);
    }
  }
  return sizes;
}

// A frame in the size and with the pads that serve a face best.
struct BridgeChoice {
  double dbl_mm = 0, shift = 0;
  FrameModel frame;
  Candidate best;
};
BridgeChoice ChooseBridge(const FrameModel& frame, const FaceRelief& relief, const EarPoints& ears,
                          const Eigen::Vector3d& pupil_right, const Eigen::Vector3d& pupil_left,
                          const FitOptions& options) {
  const auto best_of = [&](double size) {
    const double change = size - frame.boxing.dbl_mm;
    BridgeChoice chosen;
    FrameModel made =
        std::abs(change) < 0.05 ? frame : BuildFrame(WithBridge(*frame.parameters, size, 0));
    const PadRange range = PadRangeOf(made, options);
    const Fitter fitter(made, relief, ears, pupil_right, pupil_left, options);
    const double steps = std::ceil(range.inward / kShiftStep_mm);
    for (double shift = -steps * kShiftStep_mm; shift <= range.outward + 1e-9;
         shift += kShiftStep_mm) {
      if (shift < -range.inward - 1e-9) continue;
      Candidate tried = fitter.Best(shift);
      tried.cost += kSizeWorth * change * change;
      if (tried.cost < chosen.best.cost) {
        chosen.best = tried;
        chosen.shift = std::abs(shift) < 1e-9 ? 0 : shift;
      }
    }
    chosen.dbl_mm = size;
    chosen.frame = std::move(made);
    return chosen;
  };
  std::vector<std::future<BridgeChoice>> all;
  for (const double size : SizesOf(frame, options)) {
    all.push_back(std::async(std::launch::async, best_of, size));
  }
  BridgeChoice best = all[0].get();
  for (std::size_t i = 1; i < all.size(); ++i) {
    BridgeChoice other = all[i].get();
    if (other.best.cost < best.best.cost) best = std::move(other);
  }
  return best;
}

// What was done to the bridge, for the report.
void NoteBridge(const FrameModel& made, const BridgeChoice& chosen, WearingPosition& wearing) {
  if (std::abs(chosen.dbl_mm - made.boxing.dbl_mm) > 0.05) {
    std::string sizes;
    for (const double size : made.parameters->bridge_sizes_mm) {
      sizes += fmt::format("{}{:g}", sizes.empty() ? "" : ", ", size);
    }
    wearing.notes.push_back(fmt::format("bridge size {:g} mm chosen for this nose (offered in {})",
                                        chosen.dbl_mm, sizes));
  }
  if (chosen.shift == 0) return;
  const char* how = HasPadArms(made)   ? (chosen.shift > 0 ? "bent outward" : "bent inward")
                    : chosen.shift > 0 ? "filed back"
                                       : "built up";
  wearing.notes.push_back(
      fmt::format("nose pads {} by {:.1f} mm a side", how, std::abs(chosen.shift)));
}

}  // namespace

EarPoints EstimateEars(const TriangleMesh& face, double pd_mm) {
  EarPoints ears;
  const double scale = pd_mm / 64;
  ears.right *= scale;
  ears.left *= scale;
  if (face.positions.size() == kCanonicalVertices) {
    const Eigen::Vector3d &right = face.positions[kRightSide], &left = face.positions[kLeftSide];
    const Eigen::Vector3d onward(0, 20 * scale, -25 * scale);
    ears.right = right + onward;
    ears.left = left + onward;
  }
  return ears;
}

void NoteVertexDistance(const FitOptions& options, WearingPosition& wearing) {
  const double vertex = (wearing.vertex_distance_right_mm + wearing.vertex_distance_left_mm) / 2;
  if (vertex > options.min_vertex_mm - 0.05 && vertex < options.max_vertex_mm + 0.05) return;
  wearing.notes.push_back(
      fmt::format("vertex distance {:.1f} mm, want {:.0f} to {:.0f}: this bridge on this nose "
                  "allows no better",
                  vertex, options.min_vertex_mm, options.max_vertex_mm));
}

Result<Fit> PlaceOnFace(const FrameModel& frame, const TriangleMesh& face,
                        const Eigen::Vector3d& pupil_right, const Eigen::Vector3d& pupil_left,
                        const FitOptions& options) {
  if (frame.nose_contacts.empty())
    return Failure("fit: the frame has no bridge or pads to rest on");
  const FaceRelief relief(face);
  const double pd = (pupil_left - pupil_right).norm();
  Fit fit;
  fit.ears = options.ears.value_or(EstimateEars(face, pd));
  const BridgeChoice chosen =
      ChooseBridge(frame, relief, fit.ears, pupil_right, pupil_left, options);
  Candidate best = chosen.best;
  if (!std::isfinite(best.cost)) {
    return Failure(
        "fit: the face has no nose below the frame's bridge, want a face mesh in head "
        "space, mm");
  }
  fit.frame = chosen.frame;
  fit.pad_shift_mm = chosen.shift;
  if (chosen.shift != 0 && frame.parameters) {
    // The pads as they would be made, with their own normals.
    fit.frame = BuildFrame(WithBridge(*frame.parameters, chosen.dbl_mm, chosen.shift));
  } else if (chosen.shift != 0) {
    ShiftPads(fit.frame, chosen.shift);
  }
  const Fitter fitter(fit.frame, relief, fit.ears, pupil_right, pupil_left, options);
  fitter.Settle(best);

  fit.head_from_frame.linear() = TiltRotation(best.tilt_deg);
  fit.head_from_frame.translation() << best.x, best.y, best.z;
  const Eigen::Vector3d bridge = fit.head_from_frame.translation();
  const Eigen::Vector3d turn = options.nudge_deg * (kPi / 180);
  if (turn.norm() > 0) {
    fit.head_from_frame = Eigen::Translation3d(bridge) *
                          Eigen::AngleAxisd(turn.norm(), turn.normalized()) *
                          Eigen::Translation3d(-bridge) * fit.head_from_frame;
  }
  fit.head_from_frame = Eigen::Translation3d(options.nudge_mm) * fit.head_from_frame;

  // Temples swing out or in until they pass the ears.
  const Eigen::Isometry3d frame_from_head = fit.head_from_frame.inverse();
  for (const bool right_side : {true, false}) {
    const Eigen::Vector3d ear = frame_from_head * (right_side ? fit.ears.right : fit.ears.left);
    fit.temple_opening_deg += SwingTemple(fit.frame, right_side, ear, kSwingMost_deg) / 2;
    BowTemple(fit.frame, right_side, fit.head_from_frame, face, kBowMost_mm);
  }

  WearingPosition& wearing = fit.wearing;
  wearing.pantoscopic_tilt_deg = best.tilt_deg + options.nudge_deg.x();
  MeasureWearing(fit.frame, fit.head_from_frame, pupil_right, pupil_left, options.lens_depth_mm,
                 wearing);
  const Obstacles& points = fitter.points();
  const double right = ContactDepth(points, relief, fit.head_from_frame, -1);
  const double left = ContactDepth(points, relief, fit.head_from_frame, 1);
  wearing.nose_penetration_mm = std::max({0.0, right, left});
  wearing.nose_gap_mm = std::max({0.0, -right, -left});

  NoteBridge(frame, chosen, wearing);
  const double head_width = (fit.ears.left - fit.ears.right).norm();
  const double wider = frame.temple_spread_mm - head_width;
  if (std::abs(wider) > kWidthNote_mm) {
    wearing.notes.push_back(fmt::format("frame {:.0f} mm {} than the head at the ears",
                                        std::abs(wider), wider > 0 ? "wider" : "narrower"));
  }
  return fit;
}

}  // namespace lorgnette
