// SPDX-License-Identifier: Apache-2.0
#include "geometry/frame_import.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "base/linear_algebra.h"
#include "base/units.h"
#include "geometry/closed_curve.h"
#include "geometry/contour.h"
#include "geometry/frame_axes.h"
#include "geometry/mesh_check.h"
#include "geometry/mesh_repair.h"
#include "geometry/silhouette.h"
#include "geometry/sweep.h"

namespace lorgnette {
namespace {

constexpr double kTempleBehindFront_mm = 12;  // a triangle further back at the side is a temple's
constexpr double kPadReach_mm = 16, kPadSize_mm = 22;
constexpr double kDemoLensFill = 0.55;  // of its own box: a disc, not a ring
constexpr double kEarBehindFront_mm = 98;
constexpr double kSlice_mm = 3;
constexpr double kBendDrop_mm = 2.5;
// Boxing that glasses can have.
constexpr double kLeastA_mm = 25, kGreatestA_mm = 90, kLeastB_mm = 12, kGreatestB_mm = 80;
constexpr double kLeastDbl_mm = 3, kGreatestDbl_mm = 45;
constexpr double kFullRimShare = 0.9;
constexpr double kHalfRimShare = 0.2;       // of a lens' edge that a rim holds
constexpr std::size_t kMostPartsTried = 8;  // as unnamed lenses, alone and in pairs

std::string Lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}
bool Has(const std::string& text, const char* word) { return text.find(word) != std::string::npos; }

TriangleMesh Extract(const TriangleMesh& mesh, const std::vector<std::size_t>& triangles) {
  TriangleMesh part;
  std::map<int, int> moved;
  for (const std::size_t t : triangles) {
    Eigen::Vector3i corners;
    for (int k = 0; k < 3; ++k) {
      const int from = mesh.triangles[t][k];
      const auto [at, fresh] = moved.emplace(from, int(part.positions.size()));
      if (fresh) {
        part.positions.push_back(mesh.positions[std::size_t(from)]);
        if (!mesh.normals.empty()) part.normals.push_back(mesh.normals[std::size_t(from)]);
        if (!mesh.uvs.empty()) part.uvs.push_back(mesh.uvs[std::size_t(from)]);
      }
      corners[k] = at->second;
    }
    part.triangles.push_back(corners);
  }
  return part;
}

// Connected pieces (by position), as lists of triangles.
std::vector<std::vector<std::size_t>> Pieces(const TriangleMesh& mesh) {
  const TriangleMesh merged = MergeEqualPositions(mesh);
  std::vector<int> parent(merged.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[std::size_t(v)] != v) {
      v = parent[std::size_t(v)] = parent[std::size_t(parent[std::size_t(v)])];
    }
    return v;
  };
  for (const Eigen::Vector3i& t : merged.triangles) {
    parent[std::size_t(root(t[0]))] = root(t[1]);
    parent[std::size_t(root(t[1]))] = root(t[2]);
  }
  std::map<int, std::vector<std::size_t>> pieces;
  for (std::size_t i = 0; i < merged.triangles.size(); ++i) {
    pieces[root(merged.triangles[i][0])].push_back(i);
  }
  std::vector<std::vector<std::size_t>> list;
  for (auto& [key, triangles] : pieces) list.push_back(std::move(triangles));
  return list;
}

struct Extent {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
};
Extent ExtentOf(const TriangleMesh& mesh) {
  Extent extent;
  for (const Eigen::Vector3d& p : mesh.positions) {
    extent.low = extent.low.cwiseMin(p);
    extent.high = extent.high.cwiseMax(p);
  }
  return extent;
}

double Area(const TriangleMesh& mesh) {
  double area = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.positions[std::size_t(t[0])];
    area += (mesh.positions[std::size_t(t[1])] - a)
                .cross(mesh.positions[std::size_t(t[2])] - a)
                .norm() /
            2;
  }
  return area;
}

// A filled disc of a lens' size beside the middle, seen along z.
bool ShapedLikeALens(const TriangleMesh& mesh) {
  const Extent e = ExtentOf(mesh);
  const Eigen::Vector3d size = e.high - e.low;
  if (size.x() < 30 || size.x() > 75 || size.y() < 18 || size.y() > 65) return false;
  if (e.low.x() < 0 && e.high.x() > 0) return false;
  double covered = 0;  // area of triangles that look forward, as seen along z
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.positions[std::size_t(t[0])];
    const Eigen::Vector3d n =
        (mesh.positions[std::size_t(t[1])] - a).cross(mesh.positions[std::size_t(t[2])] - a);
    covered += std::abs(n.z()) / 2;
  }
  // Both faces count where it is closed: at least one must fill the box.
  return covered > kDemoLensFill * size.x() * size.y() && SilhouetteHoles(mesh).empty();
}

class Importer {
 public:
  Importer(const ModelFile& file, const std::string& name, std::optional<double> unit_mm)
      : file_(file), name_(name), unit_mm_(unit_mm ? unit_mm : file.mm_per_unit) {}

  Result<FrameModel> Import() {
    frame_.name = name_;
    LG_RETURN_IF_ERROR(Orient());
    SplitParts();
    LG_RETURN_IF_ERROR(MeasureFront());
    Upright();
    MeasureTemples();
    FindContacts();
    return std::move(frame_);
  }

 private:
  TriangleMesh WithoutLenses() const {
    TriangleMesh all;
    for (std::size_t i = 0; i < demo_.size(); ++i) {
      if (!demo_[i]) Append(all, file_.parts[i].mesh);
    }
    return all;
  }

  // Full rims whose lenses neither name nor material tells: the axes when the given parts
  // are left out too.
  std::optional<FrameAxes> AxesWithout(std::size_t a, std::size_t b) {
    if (demo_[a] || demo_[b]) return std::nullopt;
    demo_[a] = demo_[b] = true;
    auto axes = FindFrameAxes(WithoutLenses(), unit_mm_, nullptr, false);
    if (!axes) demo_[a] = demo_[b] = false;
    return axes;
  }

  // A half rim or no rim: the two lenses stand for the openings. Parts i and j are taken for them
  // where neither name nor material tells.
  std::optional<FrameAxes> AxesByLenses(bool scan) const {
    TriangleMesh lenses;
    for (std::size_t i = 0; i < demo_.size(); ++i) {
      if (demo_[i]) Append(lenses, file_.parts[i].mesh);
    }
    if (lenses.empty()) return std::nullopt;
    TriangleMesh all = WithoutLenses();
    Append(all, lenses);
    return FindFrameAxes(all, unit_mm_, &lenses, scan);
  }
  std::optional<FrameAxes> AxesByLenses(std::size_t i, std::size_t j) {
    if (demo_[i] || demo_[j]) return std::nullopt;
    demo_[i] = demo_[j] = true;
    auto axes = AxesByLenses(false);
    if (!axes) demo_[i] = demo_[j] = false;
    return axes;
  }

  // The first answer of `ask` to one part alone, or to a pair, among those of the largest surface.
  template <typename Ask>
  std::optional<FrameAxes> FirstOfParts(const Ask& ask) {
    std::vector<std::pair<double, std::size_t>> largest;
    for (std::size_t i = 0; i < file_.parts.size(); ++i) {
      largest.emplace_back(-Area(file_.parts[i].mesh), i);
    }
    std::sort(largest.begin(), largest.end());
    const std::size_t parts = std::min(largest.size(), kMostPartsTried);
    for (std::size_t apart = 0; apart < 2; ++apart) {
      for (std::size_t i = 0; i + apart < parts; ++i) {
        for (std::size_t j = i + apart; j < (apart == 0 ? i + 1 : parts); ++j) {
          if (auto axes = ask(largest[i].second, largest[j].second)) return axes;
        }
      }
    }
    return std::nullopt;
  }

  Status Orient() {
    for (const ModelPart& part : file_.parts) {
      const std::string lower = Lower(part.name);
      demo_.push_back(Has(lower, "lens") || (part.transparent && !Has(lower, "pad")));
    }
    auto axes = FindFrameAxes(WithoutLenses(), unit_mm_);
    if (!axes) {
      axes = AxesByLenses(true);
      by_lenses_ = axes.has_value();
    }
    if (!axes) {
      axes = FirstOfParts([&](std::size_t i, std::size_t j) { return AxesWithout(i, j); });
    }
    if (!axes) {
      axes = FirstOfParts([&](std::size_t i, std::size_t j) { return AxesByLenses(i, j); });
      by_lenses_ = axes.has_value();
    }
    if (!axes) {
      return Failure(name_ +
                     ": no closed rim: two openings of like size are seen from no side, and no two "
                     "lenses; want a frame with rims or with its demo lenses");
    }
    turn_ = axes->frame_from_file;
    frame_.notes = file_.notes;
    frame_.notes.insert(frame_.notes.end(), axes->notes.begin(), axes->notes.end());
    const Extent extent = ExtentOf(WithoutLenses());
    middle_x_ = (turn_ * (extent.low + extent.high)).x() / 2;
    return {};
  }

  TriangleMesh InFrame(const TriangleMesh& mesh) const {
    TriangleMesh moved = mesh;
    const double scale = std::cbrt(turn_.determinant());
    for (Eigen::Vector3d& p : moved.positions) p = turn_ * p - Eigen::Vector3d(middle_x_, 0, 0);
    for (Eigen::Vector3d& n : moved.normals) n = turn_ * n / scale;
    return moved;
  }

  void Add(const std::string& part, FramePartKind kind, TriangleMesh mesh,
           const FrameMaterial& material) {
    if (!mesh.empty()) frame_.parts.push_back({part, kind, std::move(mesh), material});
  }

  void SplitParts() {
    std::vector<TriangleMesh> meshes;
    MeshRepair repaired;
    front_z_ = -std::numeric_limits<double>::infinity();
    double width = 0;
    for (std::size_t i = 0; i < file_.parts.size(); ++i) {
      meshes.push_back(InFrame(file_.parts[i].mesh));
      repaired.points_joined += JoinNearPoints(meshes.back());
      if (demo_[i]) continue;
      const Extent e = ExtentOf(meshes.back());
      front_z_ = std::max(front_z_, e.high.z());
      width = std::max(width, e.high.x());
    }
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      const ModelPart& from = file_.parts[i];
      if (demo_[i]) {
        frame_.notes.push_back("demo lens taken out: " + from.name);
        Append(lenses_, meshes[i]);
        continue;
      }
      for (const std::vector<std::size_t>& piece : Pieces(meshes[i])) {
        TriangleMesh mesh = Extract(meshes[i], piece);
        if (ShapedLikeALens(mesh)) {
          frame_.notes.push_back("demo lens taken out by its shape: " + from.name);
          Append(lenses_, mesh);
          continue;
        }
        repaired += RepairMesh(mesh);
        if (mesh.empty()) continue;
        Sort(from, std::move(mesh), width);
      }
    }
    const std::vector<std::string> repairs = repaired.Sentences();
    frame_.notes.insert(frame_.notes.end(), repairs.begin(), repairs.end());
  }

  // Gives a connected piece its kind; one that runs from the front into a temple is divided.
  void Sort(const ModelPart& from, TriangleMesh mesh, double width) {
    const std::string lower = Lower(from.name);
    const Extent e = ExtentOf(mesh);
    const Eigen::Vector3d size = e.high - e.low;
    if (Has(lower, "pad") || Has(lower, "nose") ||
        (size.maxCoeff() < kPadSize_mm &&
         std::max(std::abs(e.low.x()), std::abs(e.high.x())) < kPadReach_mm &&
         e.high.z() < front_z_ - 1)) {
      return Add(from.name, FramePartKind::kNosePad, std::move(mesh), from.material);
    }
    std::vector<std::size_t> sides[3];  // front, right temple, left temple
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      Eigen::Vector3d centre(0, 0, 0);
      for (int k = 0; k < 3; ++k) centre += mesh.positions[std::size_t(mesh.triangles[i][k])] / 3;
      const bool temple =
          centre.z() < front_z_ - kTempleBehindFront_mm && std::abs(centre.x()) > 0.6 * width;
      sides[!temple ? 0 : centre.x() < 0 ? 1 : 2].push_back(i);
    }
    const bool small_hinge = Has(lower, "hinge") || Has(lower, "screw");
    Add(from.name, small_hinge ? FramePartKind::kHinge : FramePartKind::kFront,
        Extract(mesh, sides[0]), from.material);
    Add(from.name + " right temple", FramePartKind::kTemple, Extract(mesh, sides[1]),
        from.material);
    Add(from.name + " left temple", FramePartKind::kTemple, Extract(mesh, sides[2]), from.material);
  }

  Status MeasureFront() {
    const TriangleMesh front = PartsOfKind(frame_, FramePartKind::kFront);
    auto traced = by_lenses_ ? TraceLenses(lenses_) : TraceOpenings(front);
    if (!traced) return Failure(name_ + ": " + traced.error().message);
    const Boxing& box = traced->boxing;
    if (box.a_mm < kLeastA_mm || box.a_mm > kGreatestA_mm || box.b_mm < kLeastB_mm ||
        box.b_mm > kGreatestB_mm || box.dbl_mm < kLeastDbl_mm || box.dbl_mm > kGreatestDbl_mm) {
      return Failure(fmt::format(
          "{}: got openings of A {:.1f}, B {:.1f}, DBL {:.1f} mm, want A {}..{}, B {}..{}, DBL "
          "{}..{}: no glasses, or another unit",
          name_, box.a_mm, box.b_mm, box.dbl_mm, kLeastA_mm, kGreatestA_mm, kLeastB_mm,
          kGreatestB_mm, kLeastDbl_mm, kGreatestDbl_mm));
    }
    frame_.right = std::move(traced->right);
    frame_.left = std::move(traced->left);
    frame_.boxing = traced->boxing;
    frame_.face_form_deg = traced->face_form_deg;
    frame_.frame_curve_diopters = traced->frame_curve_diopters;
    if (by_lenses_) {
      const double share = (RimShare(front, frame_.right) + RimShare(front, frame_.left)) / 2;
      frame_.mount = share > kFullRimShare   ? FrameMount::kFullRim
                     : share > kHalfRimShare ? FrameMount::kHalfRim
                                             : FrameMount::kRimless;
      frame_.notes.push_back(fmt::format("{}: the lens shape is that of the demo lenses",
                                         share > kFullRimShare   ? "full rim"
                                         : share > kHalfRimShare ? "half rim"
                                                                 : "rimless"));
    }
    return {};
  }

  // Origin midway between the boxing centres, the openings' planes upright.
  void Upright() {
    const Eigen::Isometry3d &right = frame_.right.frame_from_opening,
                            &left = frame_.left.frame_from_opening;
    // From one boxing centre to the other is across; the openings' mean axis is forward.
    const Eigen::Vector3d across = (left.translation() - right.translation()).normalized();
    const Eigen::Vector3d mean = right.linear().col(2) + left.linear().col(2);
    const Eigen::Vector3d forward = (mean - mean.dot(across) * across).normalized();
    Eigen::Matrix3d upright;
    upright << across, forward.cross(across), forward;
    const Eigen::Isometry3d move =
        Eigen::Isometry3d(upright.transpose()) *
        Eigen::Translation3d(-(right.translation() + left.translation()) / 2);
    for (FramePart& part : frame_.parts) {
      for (Eigen::Vector3d& p : part.mesh.positions) p = move * p;
      for (Eigen::Vector3d& n : part.mesh.normals) n = move.linear() * n;
    }
    for (LensOpening* opening : {&frame_.right, &frame_.left}) {
      opening->frame_from_opening = move * opening->frame_from_opening;
    }
    front_z_ = -std::numeric_limits<double>::infinity();
    for (const FramePart& part : frame_.parts) {
      front_z_ = std::max(front_z_, ExtentOf(part.mesh).high.z());
    }
  }

  struct Slice {
    double y = 0, x = 0, z = 0, inner = std::numeric_limits<double>::infinity();
    double lowest = std::numeric_limits<double>::infinity();
    long count = 0;
  };

  // Middle line of the temple on one side, from front to back in steps of kSlice_mm.
  std::vector<Slice> TempleLine(double side) const {
    std::map<int, Slice> slices;
    for (const FramePart& part : frame_.parts) {
      if (part.kind != FramePartKind::kTemple) continue;
      for (const Eigen::Vector3i& t : part.mesh.triangles) {
        // Corners and points between them: long triangles reach over many slices.
        for (int step = 0; step < 27; ++step) {
          const int thirds[3] = {step % 3, step / 3 % 3, step / 9};
          Eigen::Vector3d w(thirds[0], thirds[1], thirds[2]);
          if (w.sum() == 0) continue;
          w /= w.sum();
          Eigen::Vector3d p(0, 0, 0);
          for (int k = 0; k < 3; ++k) p += w[k] * part.mesh.positions[std::size_t(t[k])];
          if (p.x() * side < 0) continue;
          Slice& slice = slices[int(std::floor((front_z_ - p.z()) / kSlice_mm))];
          slice.x += p.x();
          slice.y += p.y();
          slice.z += p.z();
          slice.inner = std::min(slice.inner, std::abs(p.x()));
          slice.lowest = std::min(slice.lowest, p.y());
          ++slice.count;
        }
      }
    }
    std::vector<Slice> line;
    for (auto& [at, slice] : slices) {
      slice.x /= double(slice.count);
      slice.y /= double(slice.count);
      slice.z /= double(slice.count);
      line.push_back(slice);
    }
    return line;
  }

  void MeasureTemples() {
    double tilt = 0, length = 0, spread = 0;
    int sides = 0;
    for (const double side : {-1.0, 1.0}) {
      const std::vector<Slice> line = TempleLine(side);
      Eigen::Vector3d& ear = side < 0 ? frame_.ear_point_right : frame_.ear_point_left;
      ear = {side * 73, -kEarBehindFront_mm * std::tan(RadiansFromDegrees(8)), -kEarBehindFront_mm};
      if (line.size() < 8) continue;
      // The straight part: from the hinge over the first 60 mm.
      Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
      Eigen::Vector2d right(0, 0);
      for (const Slice& slice : line) {
        if (front_z_ - slice.z > 75) break;
        const Eigen::Vector2d row(1, slice.z);
        normal += row * row.transpose();
        right += row * slice.y;
      }
      const Eigen::Vector2d fit = SolveSymmetric(normal, right);
      std::size_t bend = line.size() - 1;
      for (std::size_t i = 0; i < line.size(); ++i) {
        const bool far = front_z_ - line[i].z > 70;
        if (far && fit[0] + fit[1] * line[i].z - line[i].y > kBendDrop_mm) {
          bend = i;
          break;
        }
      }
      ear = {line[bend].x, line[bend].lowest, line[bend].z};
      tilt += DegreesFromRadians(std::atan(fit[1]));
      for (std::size_t i = 1; i < line.size(); ++i) {
        length += std::hypot(line[i].x - line[i - 1].x, line[i].y - line[i - 1].y,
                             line[i].z - line[i - 1].z);
      }
      spread += line[bend].inner;
      ++sides;
    }
    if (sides == 2) {
      frame_.pantoscopic_tilt_deg = tilt / 2;
      frame_.temple_length_mm = length / 2;
      frame_.temple_spread_mm = spread;
    } else {
      frame_.temple_length_mm = 0;
      frame_.temple_spread_mm = 146;
      frame_.notes.push_back("temples not found on both sides: a tilt of 8 degrees is assumed");
    }
  }

  // What may touch the nose: pads where there are any, else the rims' and bridge's inner backs.
  void FindContacts() {
    const bool pads = std::any_of(frame_.parts.begin(), frame_.parts.end(), [](const FramePart& p) {
      return p.kind == FramePartKind::kNosePad;
    });
    const double reach = frame_.boxing.dbl_mm / 2 + 5;
    for (const FramePart& part : frame_.parts) {
      if (part.kind != (pads ? FramePartKind::kNosePad : FramePartKind::kFront)) continue;
      for (std::size_t i = 0; i < part.mesh.positions.size(); ++i) {
        const Eigen::Vector3d &p = part.mesh.positions[i], &n = part.mesh.normals[i];
        const double inward = -std::copysign(1.0, p.x()) * n.x();
        if (std::abs(p.x()) > reach + (pads ? 10 : 0) || p.y() > 0.45 * frame_.boxing.b_mm)
          continue;
        if (inward > 0.3 || (!pads && inward > 0 && n.z() < -0.5)) {
          frame_.nose_contacts.push_back(p);
        }
      }
    }
    if (frame_.nose_contacts.empty()) {
      frame_.notes.push_back("no pads or bridge found for the nose");
    }
  }

  const ModelFile& file_;
  std::string name_;
  std::optional<double> unit_mm_;
  std::vector<bool> demo_;
  bool by_lenses_ = false;  // no closed rims: the lenses tell the shape
  TriangleMesh lenses_;     // demo lenses, frame coordinates
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
  double middle_x_ = 0, front_z_ = 0;
  FrameModel frame_;
};

}  // namespace

Result<FrameModel> ImportFrame(const ModelFile& model, const std::string& name,
                               std::optional<double> unit_mm) {
  return Importer(model, name, unit_mm).Import();
}

}  // namespace lorgnette
