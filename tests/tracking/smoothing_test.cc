// SPDX-License-Identifier: Apache-2.0
#include "tracking/smoothing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/units.h"

namespace lorgnette {
namespace {

constexpr Eigen::Index kCount = 200;

Eigen::VectorXd Noise(double sigma) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, sigma);
  Eigen::VectorXd noise(kCount);
  for (double& v : noise) v = normal(random);
  return noise;
}

double Rms(const Eigen::VectorXd& v) { return std::sqrt(v.squaredNorm() / double(v.size())); }

TEST(Smoothed, LeavesAQuadraticAlone) {
  Eigen::MatrixXd x(kCount, 2);
  for (Eigen::Index i = 0; i < kCount; ++i) {
    const double t = double(i);
    x.row(i) << 3 - 0.2 * t + 0.01 * t * t, 5;
  }
  // The matrix has a condition of some 1e8 at this stiffness; values reach 400.
  EXPECT_LT((Smoothed(x, Eigen::VectorXd::Ones(kCount), 1e3) - x).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Smoothed, DampsASineByItsGain) {
  const double stiffness = StiffnessForCutoff(4, 30);
  for (const double hz : {1.0, 4.0, 9.0}) {
    const double w = 2 * kPi * hz / 30;
    Eigen::VectorXd x(kCount);
    for (Eigen::Index i = 0; i < kCount; ++i) x[i] = std::sin(w * double(i));
    const Eigen::VectorXd y = Smoothed(x, Eigen::VectorXd::Ones(kCount), stiffness);
    const double gain = 1 / (1 + stiffness * std::pow(2 * std::sin(w / 2), 6));
    // Away from the ends, whose influence falls by e every few samples.
    const Eigen::Index from = 60, length = 80;
    EXPECT_LT((y - gain * x).segment(from, length).cwiseAbs().maxCoeff(), 1e-4) << hz << " Hz";
  }
}

TEST(StiffnessForCutoff, HalvesTheCutoff) {
  const double w = 2 * kPi * 5 / 25;
  EXPECT_NEAR(StiffnessForCutoff(5, 25) * std::pow(2 * std::sin(w / 2), 6), 1, 1e-12);
}

TEST(Smoothed, IsTheSameBackwards) {
  const Eigen::MatrixXd x = Noise(1);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(kCount);
  const Eigen::MatrixXd reversed = x.colwise().reverse();
  const Eigen::MatrixXd back = Smoothed(reversed, ones, 20).colwise().reverse();
  EXPECT_LT((back - Smoothed(x, ones, 20)).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(Smoothed, FillsGapsFromBothSides) {
  Eigen::MatrixXd x(40, 1);
  for (Eigen::Index i = 0; i < 40; ++i) x(i, 0) = 2 * double(i) + 1;
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(40);
  const Eigen::MatrixXd truth = x;
  for (Eigen::Index i = 15; i < 22; ++i) {
    weights[i] = 0;
    x(i, 0) = -500;
  }
  EXPECT_LT((Smoothed(x, weights, 5) - truth).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Smoothed, ReturnsTooFewSamplesAsTheyAre) {
  const Eigen::MatrixXd x = Eigen::MatrixXd::Random(3, 2);
  EXPECT_EQ(Smoothed(x, Eigen::VectorXd::Ones(3), 10), x);
  const Eigen::MatrixXd y = Eigen::MatrixXd::Random(9, 1);
  EXPECT_EQ(Smoothed(y, Eigen::VectorXd::Zero(9), 10), y);
}

TEST(SmoothedKeepingJumps, SmoothsNoise) {
  const Eigen::VectorXd noise = Noise(0.1);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(kCount);
  const double stiffness = StiffnessForCutoff(3, 30);
  const double plain = Rms(Smoothed(noise, ones, stiffness));
  // One sample in 370 of white noise stands out by three deviations and is kept.
  EXPECT_LT(Rms(SmoothedKeepingJumps(noise, ones, stiffness, 3)), 1.5 * plain);
  EXPECT_LT(plain, 0.06);
}

TEST(SmoothedKeepingJumps, KeepsAStepSharp) {
  Eigen::VectorXd x = Noise(0.02);
  x.tail(kCount / 2).array() += 10;
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(kCount);
  const double stiffness = StiffnessForCutoff(3, 30);
  const Eigen::VectorXd y = SmoothedKeepingJumps(x, ones, stiffness, 3);
  // Half a step of error is what the plain smoother leaves beside the step.
  EXPECT_LT((y - x).cwiseAbs().maxCoeff(), 0.1);
  EXPECT_GT((Smoothed(x, ones, stiffness) - x).cwiseAbs().maxCoeff(), 3);
}

TEST(SmoothedKeepingJumps, DoesNotFollowASampleWithoutTrust) {
  Eigen::VectorXd x = Noise(0.02), trust = Eigen::VectorXd::Ones(kCount);
  x[100] += 10;
  trust[100] = 0.01;
  EXPECT_LT(std::abs(SmoothedKeepingJumps(x, trust, StiffnessForCutoff(3, 30), 3)[100]), 0.5);
}

}  // namespace
}  // namespace lorgnette
