// SPDX-License-Identifier: Apache-2.0
// The face that the picture looks at: how deep each of its points lies behind the lens.
//
// A smooth average face, the same for every wearer: it recedes toward the temples, and nose, brows
// and cheeks stand before the plane of the irises by some closed bumps that vanish at the eyes.
// Lengths in mm: x from the middle of the face, y up from the pupils' height.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "optics/ray.h"

namespace lorgnette::page {

struct FaceDepth {
  double depth = 0;  // behind the plane of the irises, positive away from the lens
  double by_x = 0, by_y = 0;
};
FaceDepth FaceAt(double x, double y);

// Where a ray first gets behind the face: iris_z is the z of the irises' plane, face_x the distance
// of the ray's x = 0 from the middle of the face. nullopt when it never does.
std::optional<Eigen::Vector3d> MeetFace(const Ray& ray, double iris_z, double face_x);

}  // namespace lorgnette::page
