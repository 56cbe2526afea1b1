// SPDX-License-Identifier: Apache-2.0
// Closed forms of small problems for which Eigen brings its general solvers along.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lorgnette {

// The smaller and the greater eigenvalue of a symmetric matrix.
Eigen::Vector2d SymmetricEigenvalues(const Eigen::Matrix2d& m);

// The shortest turn that takes one direction to the other; neither may be zero. Of opposite
// directions, half a turn about some axis across them.
Eigen::Quaterniond ShortestTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace lorgnette
