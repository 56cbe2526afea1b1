// SPDX-License-Identifier: Apache-2.0
// Small problems of linear algebra: closed forms, and Eigen's solvers compiled once, not for every
// size and caller.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lorgnette {

// The smaller and the greater eigenvalue of a symmetric matrix.
Eigen::Vector2d SymmetricEigenvalues(const Eigen::Matrix2d& m);

// The x of a x = b, a column for each of `b`, for a symmetric, positive semidefinite `a`: normal
// equations, say. Of a singular one, some x; not a number where `a` is not. Method: LDL^T with
// pivots (Eigen).
Eigen::MatrixXd SolveSymmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

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
