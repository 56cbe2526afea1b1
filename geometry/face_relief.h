// SPDX-License-Identifier: Apache-2.0
// A face seen from straight ahead as a height map: how far forward the skin lies at (x, y).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "base/mesh.h"

namespace lorgnette {

class FaceRelief {
 public:
  // Head space; the part within `reach_mm` of the origin in x and y; what lies deeper than
  // `deepest_z_mm` is left out (the inside of the head, the ears).
  explicit FaceRelief(const TriangleMesh& face, double step_mm = 0.5, double reach_mm = 78,
                      double deepest_z_mm = -60);

  // Greatest z of the skin, bilinear between the cells' exact values; nullopt beside the face.
  std::optional<double> Height(double x, double y) const;
  // Unit, toward +z; from the slope of Height.
  std::optional<Eigen::Vector3d> Normal(double x, double y) const;

 private:
  double step_, reach_;
  int size_;
  std::vector<float> z_;  // NaN: no skin
};

}  // namespace lorgnette
