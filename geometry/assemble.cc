// SPDX-License-Identifier: Apache-2.0
#include "geometry/assemble.h"

#include <utility>

#include "geometry/frame_adjust.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

Error About(Eye eye, Error error) {
  error.message = (eye == Eye::kRight ? "right lens: " : "left lens: ") + error.message;
  return error;
}

// Along head z from the cornea to the back surface; nullopt when the line misses it.
std::optional<double> VertexDistance(const CutLens& lens, const Eigen::Isometry3d& head_from_frame,
                                     const Eigen::Vector3d& pupil) {
  const Eigen::Isometry3d lens_from_head = (head_from_frame * lens.frame_from_lens).inverse();
  const Ray sight{lens_from_head * pupil, lens_from_head.linear() * Eigen::Vector3d::UnitZ()};
  const auto hit = IntersectBack(lens.lens.lens(), sight);
  return hit ? std::optional(hit->distance) : std::nullopt;
}

Result<CutLens> MakeLens(Eye eye, const Fit& fit, const Prescription& prescription,
                         const Eigen::Vector3d& pupil, const EyewearOptions& options) {
  Eigen::Vector2d centre;
  const LensOrder order = OrderLens(eye, fit, prescription, pupil, options, centre);
  LG_ASSIGN(LensDesign design, DesignLens(order));
  LG_ASSIGN(const CertifiedLens certified, Certify(std::move(design)));
  CutOptions cut = options.cut;
  if (!cut.edge) cut.edge = EdgeFor(fit.frame.mount);
  return CutAndMount(certified, eye == Eye::kRight ? fit.frame.right : fit.frame.left, centre, cut);
}

}  // namespace

LensOrder OrderLens(Eye eye, const Fit& fit, const Prescription& prescription,
                    const Eigen::Vector3d& pupil, const EyewearOptions& options,
                    Eigen::Vector2d& optical_centre) {
  const bool right = eye == Eye::kRight;
  const LensOpening& opening = right ? fit.frame.right : fit.frame.left;
  optical_centre = PupilInOpening(opening, fit.head_from_frame, pupil);
  optical_centre.y() -= options.drop_mm_per_degree * fit.wearing.pantoscopic_tilt_deg;
  LensOrder order;
  order.eye = eye;
  order.rx = right ? prescription.right : prescription.left;
  order.medium = options.medium;
  order.base_curve = options.base_curve;
  order.center_thickness_mm = options.center_thickness_mm;
  order.min_center_thickness_mm = options.min_center_thickness_mm;
  order.min_edge_thickness_mm = options.min_edge_thickness_mm;
  order.contour_mm = ContourInLensFrame(opening.contour_mm, optical_centre);
  order.vertex_distance_mm =
      right ? fit.wearing.vertex_distance_right_mm : fit.wearing.vertex_distance_left_mm;
  return order;
}

Result<Eyewear> MakeEyewear(const Fit& fit, const Prescription& prescription,
                            const Eigen::Vector3d& pupil_right, const Eigen::Vector3d& pupil_left,
                            const EyewearOptions& options) {
  const auto make = [&](Eye eye, const Eigen::Vector3d& pupil) {
    return MakeLens(eye, fit, prescription, pupil, options).map_error([&](Error error) {
      return About(eye, std::move(error));
    });
  };
  LG_ASSIGN(CutLens right, make(Eye::kRight, pupil_right));
  LG_ASSIGN(CutLens left, make(Eye::kLeft, pupil_left));
  Eyewear eyewear{fit.frame, std::move(right), std::move(left), fit.head_from_frame, fit.wearing};
  WearingPosition& wearing = eyewear.wearing;
  for (const auto& [lens, side] :
       {std::pair(&eyewear.right, "right lens: "), std::pair(&eyewear.left, "left lens: ")}) {
    for (const std::string& note : lens->notes) wearing.notes.push_back(side + note);
  }
  if (const auto d = VertexDistance(eyewear.right, fit.head_from_frame, pupil_right)) {
    wearing.vertex_distance_right_mm = *d;
  }
  if (const auto d = VertexDistance(eyewear.left, fit.head_from_frame, pupil_left)) {
    wearing.vertex_distance_left_mm = *d;
  }
  return eyewear;
}

Result<FittedEyewear> FitEyewear(const FrameModel& frame, const TriangleMesh& face,
                                 const Eigen::Vector3d& pupil_right,
                                 const Eigen::Vector3d& pupil_left,
                                 const Prescription& prescription, const FitOptions& fit_options,
                                 const EyewearOptions& options) {
  LG_ASSIGN(const Fit first, PlaceOnFace(frame, face, pupil_right, pupil_left, fit_options));
  LG_ASSIGN(const Eyewear tried,
            MakeEyewear(first, prescription, pupil_right, pupil_left, options));
  // How much nearer to the eyes the lenses are than was assumed.
  const double deeper =
      (first.wearing.vertex_distance_right_mm + first.wearing.vertex_distance_left_mm -
       tried.wearing.vertex_distance_right_mm - tried.wearing.vertex_distance_left_mm) /
      2;
  FitOptions again = fit_options;
  again.lens_depth_mm += deeper;
  LG_ASSIGN(Fit fit, PlaceOnFace(frame, face, pupil_right, pupil_left, again));
  LG_ASSIGN(Eyewear eyewear, MakeEyewear(fit, prescription, pupil_right, pupil_left, options));
  return FittedEyewear{std::move(fit), std::move(eyewear)};
}

}  // namespace lorgnette
