// SPDX-License-Identifier: Apache-2.0
// Smoothing of evenly spaced samples in both directions at once: no lag, ends included.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace lorgnette {

// Minimises sum weight_i |y_i - x_i|^2 + stiffness * sum |third difference of y|^2 for every column
// of `samples` (one row a time step). A quadratic in time passes unchanged; a sine of w radians a
// sample is scaled by 1 / (1 + stiffness * (2 sin(w / 2))^6) with unit weights. Weight 0: the value
// is filled in from its neighbours. Needs three positive weights or fewer samples than four;
// otherwise returns `samples`. (Whittaker 1923; Eilers 2003, "A perfect smoother".)
// Tested: quadratics, the sine's gain, symmetry in time.
Eigen::MatrixXd Smoothed(const Eigen::MatrixXd& samples, const Eigen::VectorXd& weights,
                         double stiffness);

// The same for one column, except that samples which stand out from the curve by more than
// `outstanding` times the noise pull it to themselves: the noise is smoothed away, true jumps (a
// head that starts, a camera that drops a picture) stay. The noise is told from the third
// differences. Tested: noise shrinks as in Smoothed; a step keeps its place and height.
//   trust  one a sample, 0..1: its weight; below 1/2 a sample that stands out is an error, no jump
Eigen::VectorXd SmoothedKeepingJumps(const Eigen::VectorXd& samples, const Eigen::VectorXd& trust,
                                     double stiffness, double outstanding);

// The stiffness that halves a sine of `cutoff_hz` at `rate_hz` samples a second.
double StiffnessForCutoff(double cutoff_hz, double rate_hz);

}  // namespace lorgnette
