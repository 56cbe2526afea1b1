// SPDX-License-Identifier: Apache-2.0
#include "tracking/smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "base/units.h"

namespace lorgnette {
namespace {

constexpr int kBand = 3;             // of the third difference
constexpr double kMostWeight = 1e5;  // of a sample that stands out
constexpr std::array<double, 4> kDifference{-1, 3, -3, 1};

// Lower band of a symmetric matrix: row i holds columns i - 3 .. i.
using Band = Eigen::Matrix<double, Eigen::Dynamic, kBand + 1, Eigen::RowMajor>;

Band NormalMatrix(const Eigen::VectorXd& weights, double stiffness) {
  const Eigen::Index n = weights.size();
  Band band = Band::Zero(n, kBand + 1);
  band.col(kBand) = weights;
  for (Eigen::Index first = 0; first + kBand < n; ++first) {
    for (int a = 0; a <= kBand; ++a) {
      for (int b = 0; b <= a; ++b) {
        band(first + a, kBand - a + b) +=
            stiffness * kDifference[std::size_t(a)] * kDifference[std::size_t(b)];
      }
    }
  }
  return band;
}

// Cholesky factor in place; false when the matrix is not positive definite.
bool Factor(Band& band) {
  for (Eigen::Index i = 0; i < band.rows(); ++i) {
    for (Eigen::Index j = std::max<Eigen::Index>(0, i - kBand); j <= i; ++j) {
      double sum = band(i, kBand - (i - j));
      for (Eigen::Index k = std::max<Eigen::Index>(0, i - kBand); k < j; ++k) {
        sum -= band(i, kBand - (i - k)) * band(j, kBand - (j - k));
      }
      if (i == j) {
        if (!(sum > 0)) return false;
        band(i, kBand) = std::sqrt(sum);
      } else {
        band(i, kBand - (i - j)) = sum / band(j, kBand);
      }
    }
  }
  return true;
}

void Solve(const Band& factor, Eigen::MatrixXd& columns) {
  const Eigen::Index n = factor.rows();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = std::max<Eigen::Index>(0, i - kBand); k < i; ++k) {
      columns.row(i) -= factor(i, kBand - (i - k)) * columns.row(k);
    }
    columns.row(i) /= factor(i, kBand);
  }
  for (Eigen::Index i = n; i-- > 0;) {
    for (Eigen::Index k = i + 1; k <= std::min(n - 1, i + kBand); ++k) {
      columns.row(i) -= factor(k, kBand - (k - i)) * columns.row(k);
    }
    columns.row(i) /= factor(i, kBand);
  }
}

}  // namespace

Eigen::MatrixXd Smoothed(const Eigen::MatrixXd& samples, const Eigen::VectorXd& weights,
                         double stiffness) {
  LG_CHECK_EQ(samples.rows(), weights.size());
  if (samples.rows() <= kBand || (weights.array() > 0).count() < kBand) return samples;
  Band band = NormalMatrix(weights, stiffness);
  if (!Factor(band)) return samples;
  Eigen::MatrixXd smooth = weights.asDiagonal() * samples;
  Solve(band, smooth);
  return smooth;
}

namespace {

// Standard deviation of white noise on a smooth curve: its third differences vary by 1 + 9 + 9 + 1
// times as much, and 1.4826 times the median deviation is a normal standard deviation.
double NoiseOf(const Eigen::VectorXd& samples) {
  std::vector<double> differences;
  for (Eigen::Index i = 0; i + kBand < samples.size(); ++i) {
    double sum = 0;
    for (int k = 0; k <= kBand; ++k) sum += kDifference[std::size_t(k)] * samples[i + k];
    differences.push_back(std::abs(sum));
  }
  const auto middle = differences.begin() + long(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return 1.4826 * *middle / std::sqrt(20.0);
}

}  // namespace

Eigen::VectorXd SmoothedKeepingJumps(const Eigen::VectorXd& samples, const Eigen::VectorXd& trust,
                                     double stiffness, double outstanding) {
  LG_CHECK_EQ(samples.size(), trust.size());
  constexpr int kRounds = 6;
  if (samples.size() <= kBand) return samples;
  const double limit = outstanding * NoiseOf(samples);
  Eigen::VectorXd weights = trust;
  Eigen::VectorXd smooth = Smoothed(samples, weights, stiffness);
  if (!(limit > 0)) return smooth;
  for (int round = 0; round < kRounds; ++round) {
    for (Eigen::Index i = 0; i < samples.size(); ++i) {
      const double excess = std::abs(samples[i] - smooth[i]) / limit;
      if (excess > 1 && trust[i] >= 0.5)
        weights[i] = std::min(kMostWeight, weights[i] * (1 + excess * excess));
    }
    smooth = Smoothed(samples, weights, stiffness);
  }
  return smooth;
}

double StiffnessForCutoff(double cutoff_hz, double rate_hz) {
  const double w = std::min(kPi, 2 * kPi * cutoff_hz / rate_hz);
  return std::pow(2 * std::sin(w / 2), -6);
}

}  // namespace lorgnette
