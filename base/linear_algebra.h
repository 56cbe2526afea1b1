// SPDX-License-Identifier: Apache-2.0
// Closed forms of small problems for which Eigen brings its general solvers along.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lorgnette {

// The smaller and the greater eigenvalue of a symmetric matrix.
Eigen::Vector2d SymmetricEigenvalues(const Eigen::Matrix2d& m);

// The x that makes |a x - b| least, and of several the shortest: columns of `a` that depend on the
// others within a few roundings do not count. For few unknowns; `a` has no fewer rows than columns.
// Method: one-sided Jacobi rotations (Hestenes 1958), which find small singular values as exactly
// as large ones (Demmel and Veselic 1992). Tested: known solutions, optimality, the shortest of
// many.
Eigen::VectorXd LeastSquares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

// The shortest turn that takes one direction to the other; neither may be zero. Of opposite
// directions, half a turn about some axis across them.
Eigen::Quaterniond ShortestTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace lorgnette
