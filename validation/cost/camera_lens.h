// SPDX-License-Identifier: Apache-2.0
// One lens before a camera: the rays of its pixels, where they would leave the lens and meet the
// face, and how far any other way of following them errs.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "optics/lens.h"
#include "optics/lens_kernel.h"
#include "validation/cost/study.h"

namespace lorgnette::validation {

// Pinhole camera on the axis before the lens; the face is a plane behind it.
struct LensView {
  double camera_mm = 500;                // before the front vertex
  double face_mm = 17;                   // behind the back vertex
  double focal_px = 1500;                // of the camera
  double width_mm = 50, height_mm = 38;  // elliptic outline of the lens
};

// A ray behind the lens: where it crosses the plane of the back vertex, and its slopes there.
struct ExitRay {
  bool ok = false;
  Eigen::Vector2d at{0, 0};     // mm
  Eigen::Vector2d slope{0, 0};  // dx/dz, dy/dz
};

// The rays of one picture: one a pixel, in rows, with those outside the lens marked.
class CameraRays {
 public:
  CameraRays(const Lens& lens, const LensView& view);

  const LensView& view() const { return view_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  std::size_t size() const { return slopes_.size(); }
  std::size_t inside_count() const { return inside_count_; }
  bool inside(std::size_t i) const { return inside_[i]; }
  // Slopes of the ray from the camera at (0, 0, -camera_mm).
  const Eigen::Vector2d& slope(std::size_t i) const { return slopes_[i]; }
  Eigen::Vector3d origin() const { return {0, 0, -view_.camera_mm}; }
  Eigen::Vector3d direction(std::size_t i) const {
    return Eigen::Vector3d(slopes_[i].x(), slopes_[i].y(), 1).normalized();
  }
  // Pixels of the picture that a mm on the face spans.
  double px_per_mm() const {
    return view_.focal_px / (view_.camera_mm + thickness_ + view_.face_mm);
  }
  // Distance of neighbouring rays where they meet the lens, mm.
  double spacing_mm() const { return view_.camera_mm / view_.focal_px; }

  // From a point and a direction behind the lens.
  ExitRay ExitFrom(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;
  Eigen::Vector2d FaceHit(const ExitRay& ray) const { return ray.at + view_.face_mm * ray.slope; }

 private:
  LensView view_;
  double thickness_;
  int columns_, rows_;
  std::vector<Eigen::Vector2d> slopes_;
  std::vector<bool> inside_;
  std::size_t inside_count_ = 0;
};

// Long double rays, at the index of the design and at those of red and blue light.
struct LensReference {
  std::vector<ExitRay> design, red, blue;
};
inline constexpr double kRed_nm = 610, kBlue_nm = 465;  // where the primaries of a display are
LensReference TraceReference(const Lens& lens, const CameraRays& rays);

// What a way of tracing found: at the design's index, and for red and blue where it tells them
// apart (empty: it does not).
struct LensAnswer {
  std::vector<ExitRay> design, red, blue;
};

// Root mean square and greatest errors over the rays, in the order of LensUnits(): on the face in
// pixels; of the local magnification, by differences of neighbouring pixels; of the power over
// kPowerBase_mm of the lens; of the ray's direction; of red and blue on the face in pixels.
inline constexpr double kPowerBase_mm = 4;
std::vector<ErrorUnit> LensUnits();
void SetErrors(const CameraRays& rays, const LensReference& reference, const LensAnswer& answer,
               CostPoint& point);

}  // namespace lorgnette::validation
