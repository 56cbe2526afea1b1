// SPDX-License-Identifier: Apache-2.0
// What an optician bends on a frame to fit it to a head, and how the worn frame measures.
#pragma once

#include <Eigen/Geometry>

#include "geometry/eyewear.h"
#include "geometry/frame_model.h"

namespace lorgnette {

// Moves each pad outward (away from the middle plane) by shift_mm, its arm bending with it: the
// arm's end at the rim stays.
void ShiftPads(FrameModel& frame, double shift_mm);

// Swings the right or the left temple about the upright line through its hinge until its inner face
// passes the ear (frame coordinates), by no more than most_deg. Returns the swing in degrees,
// outward positive.
double SwingTemple(FrameModel& frame, bool right, const Eigen::Vector3d& ear, double most_deg);

// Bows the right or the left temple outward between hinge and bend until the head's side no longer
// enters it, by no more than most_mm. Returns the bow's height, mm.
double BowTemple(FrameModel& frame, bool right, const Eigen::Isometry3d& head_from_frame,
                 const TriangleMesh& head, double most_mm);

// Vertex distances (along head z from each cornea to the opening's plane, less lens_depth_mm),
// fitting heights, face form.
void MeasureWearing(const FrameModel& frame, const Eigen::Isometry3d& head_from_frame,
                    const Eigen::Vector3d& pupil_right, const Eigen::Vector3d& pupil_left,
                    double lens_depth_mm, WearingPosition& wearing);

// Where the line of sight straight ahead (+z of the head) from a pupil meets an opening's plane, in
// opening coordinates.
Eigen::Vector2d PupilInOpening(const LensOpening& opening, const Eigen::Isometry3d& head_from_frame,
                               const Eigen::Vector3d& pupil);

}  // namespace lorgnette
