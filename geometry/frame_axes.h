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
//   lenses   where given, their two discs are looked for in place of two openings (half rim,
//   rimless)
// The file's axes are taken where the glasses are symmetric across one of them; else the plane of
// symmetry is found by the mesh's principal axes. The front is then looked for in steps of 15
// degrees around the axis across (`scan`; else along the file's axes alone). nullopt when two
// openings (discs) are seen from nowhere.
std::optional<FrameAxes> FindFrameAxes(const TriangleMesh& mesh, std::optional<double> unit_mm,
                                       const TriangleMesh* lenses = nullptr, bool scan = true);

}  // namespace lorgnette
