// SPDX-License-Identifier: Apache-2.0
// A mesh seen along z: the regions that it covers and those that it encloses.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/mesh.h"

namespace lorgnette {

// A connected region in x and y, to 0.25 mm.
struct SilhouetteRegion {
  Eigen::Vector2d centre{0, 0};  // of its area, mm
  Eigen::Vector2d low{0, 0}, high{0, 0};
  double area_mm2 = 0;
};

// Empty regions that the mesh encloses, greatest first.
std::vector<SilhouetteRegion> SilhouetteHoles(const TriangleMesh& mesh);
// Regions that it covers, greatest first.
std::vector<SilhouetteRegion> SilhouetteDiscs(const TriangleMesh& mesh);

// Neither looks at a mesh wider or higher than this: the result is empty.
inline constexpr double kWidestSilhouette_mm = 1000;

}  // namespace lorgnette
