// SPDX-License-Identifier: Apache-2.0
// Which way a model of glasses stands.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "base/mesh.h"

namespace lorgnette {

struct FrameAxes {
  Eigen::Matrix3d frame_from_file = Eigen::Matrix3d::Identity();  // turn and scale, no mirror image
  std::vector<std::string> notes;
};

// Share of the vertices that have another at their mirror image across the middle of `axis`.
double MirrorShare(const TriangleMesh& mesh, int axis);

//   mesh     the glasses without lenses, file coordinates
//   unit_mm  mm per file unit where known; an implausible one is told and replaced
// nullopt when two openings are seen along no axis.
std::optional<FrameAxes> FindFrameAxes(const TriangleMesh& mesh, std::optional<double> unit_mm);

}  // namespace lorgnette
