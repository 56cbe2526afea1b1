// SPDX-License-Identifier: Apache-2.0
// A symmetric positive definite system whose entries all lie near the diagonal, as the normal
// equations of a fit by splines do: solved in n band^2 operations instead of n^3 / 3.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace lorgnette {

class BandedSystem {
 public:
  //   size  unknowns;  band  the largest row - column of an entry that is not zero
  BandedSystem(int size, int band);

  int size() const { return int(lower_.cols()); }
  // An entry of the lower triangle: 0 <= row - column <= band.
  double& operator()(int row, int column) { return lower_(row - column, column); }
  // The mean of the diagonal.
  double MeanDiagonal() const { return lower_.row(0).mean(); }

  // The solution, by L D L^T without a change of order; it leaves the factors in place of the
  // entries. nullopt where the matrix is not positive definite, and for no other reason.
  // Tested: against Eigen's dense factors, to the bound of backward stability.
  std::optional<Eigen::VectorXd> SolveInPlace(Eigen::VectorXd right);

 private:
  Eigen::MatrixXd lower_;  // (row - column, column)
};

}  // namespace lorgnette
