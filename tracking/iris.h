// SPDX-License-Identifier: Apache-2.0
// The irises: where the pupils are, more exactly than the lids can tell, and a scale of their own.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "base/camera.h"
#include "tracking/crop_store.h"
#include "tracking/face_model.h"

namespace lorgnette {

// Horizontal visible iris diameter of adults: 11.7 mm, standard deviation 0.4 mm between people.
inline constexpr double kIrisDiameterMm = 11.7, kIrisDiameterSigmaMm = 0.4;

struct Iris {
  Eigen::Vector2d pixel;  // centre in the frame
  double radius_mm = 0;   // at the head's present scale
  double contrast = 0;    // grey levels between iris and white, mean of both sides
};

// Looks for the dark disc of the iris about the expected apex: the circle whose left and right rims
// have the greatest step from dark to bright (Daugman 1993, the sides only, since lids cover top
// and bottom), then moved to where the brightness rises most along its free radii. nullopt for a
// closed or turned-away eye.
//   apex       expected corneal apex, head space
//   pd_mm      the head's present scale, from which the radius is expected
// Tested: centre to a thirtieth of its diameter, radius to a fiftieth.
std::optional<Iris> FindIris(const FaceCrop& crop, const Camera& camera,
                             const Eigen::Isometry3d& camera_from_head, const Eigen::Vector3d& apex,
                             double pd_mm);

struct IrisReading {
  std::optional<Iris> right, left;
};

// What a clip's irises say together, at the head's present scale.
struct IrisSummary {
  int frames = 0;                // with both irises
  Pupils pupils;                 // medians, head space, depth as expected
  double distance_sigma_mm = 0;  // standard error of their distance
  double diameter_mm = 0;        // median, at the present scale
  // Distance between the pupils if the irises are of the usual size, with its standard error
  // (frames' scatter and people's spread).
  double pd_mm = 0, pd_sigma_mm = 0;
};

// nullopt when fewer than three frames show both irises, or none of a shorter clip does.
std::optional<IrisSummary> SummariseIrises(const std::vector<IrisReading>& readings,
                                           const Camera& camera,
                                           const std::vector<Eigen::Isometry3d>& poses,
                                           const Pupils& expected);

}  // namespace lorgnette
