// SPDX-License-Identifier: Apache-2.0
// The rim of a parametric frame as a smooth solid: everything that joins the rim (bridge, end
// piece, pads' arms) asks it where it is.
#pragma once

#include <Eigen/Geometry>

#include "geometry/closed_curve.h"
#include "geometry/frame_parameters.h"
#include "geometry/sweep.h"

namespace lorgnette {

// The wearer's left rim. Parameter s in [0, 1) runs counter-clockwise along the outline; u is the
// distance beyond the outline in the opening's plane, w toward the front.
class RimShape {
 public:
  explicit RimShape(const FrameParameters& parameters);

  const ClosedSpline& outline() const { return outline_; }  // boxing centre at the origin
  double Width(double s) const;                             // of the rim beyond the outline
  // The groove's height over the opening's plane: it lies on the sphere of the frame curve, and
  // the mean height along the outline is 0.
  double GrooveHeight(const Eigen::Vector2d& p) const;
  Eigen::Vector3d Point(double s, double u, double w) const;  // frame coordinates
  double ParameterAtAngle(double angle_deg) const;            // of the outline's point
  double OuterReach() const;                                  // greatest x of the rim, frame
  LensOpening Opening(int points) const;                      // the true contour and aperture
  TriangleMesh Mesh(const MeshFineness& fineness) const;
  // Of a half rim: a bar over the lens' edge from the temple over the top to the nose, between the
  // outline's points at the two angles (from below 0, to above 180), without groove.
  TriangleMesh UpperMesh(double from_deg, double to_deg, const MeshFineness& fineness) const;
  const Eigen::Isometry3d& frame_from_opening() const { return frame_from_opening_; }

 private:
  Section SectionAt(double s) const;

  RimParameters rim_;
  ClosedSpline outline_;
  double curvature_;  // of the frame curve, 1/mm
  double mean_sag_ = 0;
  Eigen::Isometry3d frame_from_opening_ = Eigen::Isometry3d::Identity();
};

// Mirror images in the middle plane x = 0.
TriangleMesh MirroredX(const TriangleMesh& mesh);
Eigen::Vector3d MirroredX(const Eigen::Vector3d& p);
LensOpening MirroredX(const LensOpening& opening);

}  // namespace lorgnette
