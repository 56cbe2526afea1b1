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

// The stiffness that halves a sine of `cutoff_hz` at `rate_hz` samples a second.
double StiffnessForCutoff(double cutoff_hz, double rate_hz);

}  // namespace lorgnette
