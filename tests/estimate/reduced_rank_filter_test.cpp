// The filter against the Kalman filter on the full state with all matrices explicit.
#include "sinew/estimate/reduced_rank_filter.hpp"

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace sinew::estimate {
namespace {

constexpr int kMasses = 6, kStates = 2 * kMasses, kChainSteps = 60, kChainLags = 3;
constexpr double kChainTime = 0.02;  // s, per step

// A chain of masses and springs, held at one end, in backward Euler steps. Forces act on the last
// mass and the middle one; two positions are measured.
struct Chain {
  MatrixX transition{kStates, kStates}, input{kStates, 2}, output = MatrixX::Zero(2, kStates);
  VectorX prior{{1.0, 0.5}}, walk{{2.0, 0.0}}, variance{{1e-4, 4e-4}};
  std::vector<VectorX> measured;  // per step

  Chain() {
    MatrixX stiffness = MatrixX::Zero(kMasses, kMasses);
    for (int k = 0; k < kMasses; ++k) {
      stiffness(k, k) = k + 1 < kMasses ? 100.0 : 50.0;
      if (k > 0) stiffness(k, k - 1) = stiffness(k - 1, k) = -50.0;
    }
    const double mass = 0.1, damping = 0.05;
    MatrixX left = stiffness;
    left.diagonal().array() += mass / (kChainTime * kChainTime) + damping / kChainTime;
    const MatrixX inverse = left.inverse();
    MatrixX pull = MatrixX::Zero(kMasses, 2);
    pull(kMasses - 1, 0) = pull(kMasses / 2, 1) = 1.0;
    // q' = A^-1 (m/h^2 q + c/h q + m/h v + f), v' = (q' - q)/h
    const MatrixX of_place = inverse * (mass / (kChainTime * kChainTime) + damping / kChainTime);
    const MatrixX of_speed = inverse * (mass / kChainTime);
    const MatrixX one = MatrixX::Identity(kMasses, kMasses);
    transition << of_place, of_speed, (of_place - one) / kChainTime, of_speed / kChainTime;
    input << inverse * pull, inverse * pull / kChainTime;
    output(0, kMasses - 1) = output(1, 1) = 1.0;
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    VectorX state = VectorX::Zero(kStates);
    for (int k = 0; k < kChainSteps; ++k) {
      const VectorX force{{std::sin(0.1 * k), 0.3}};
      state = transition * state + input * force;
      measured.push_back(output * state);
      measured.back()[0] += 0.01 * normal(random);
      measured.back()[1] += 0.02 * normal(random);
    }
  }

  // The Kalman filter for (x, s) (Simon 2006, sec. 5.1).
  void kalman(VectorX& mean, MatrixX& covariance) const {
    const Eigen::Index all = 2 + kStates;
    MatrixX step = MatrixX::Identity(all, all), seen = MatrixX::Zero(2, all);
    step.bottomLeftCorner(kStates, 2) = input;
    step.bottomRightCorner(kStates, kStates) = transition;
    seen.rightCols(kStates) = output;
    mean = VectorX::Zero(all);
    covariance = MatrixX::Zero(all, all);
    covariance.diagonal().head(2) = prior.cwiseAbs2();
    for (const VectorX& own : measured) {
      covariance.diagonal().head(2) += kChainTime * walk.cwiseAbs2();
      mean = step * mean;
      covariance = step * covariance * step.transpose();
      MatrixX s = seen * covariance * seen.transpose();
      s.diagonal() += variance;
      const MatrixX gain = covariance * seen.transpose() * s.inverse();
      mean += gain * (own - seen * mean);
      covariance = (MatrixX::Identity(all, all) - gain * seen) * covariance;
    }
  }
};

// Simulation of the chain with the estimated forces.
struct Path {
  const Chain& chain;
  ReducedRankFilter filter;
  VectorX state = VectorX::Zero(kStates);
  std::vector<VectorX> readings;

  Path(const Chain& of, Eigen::Index rank)
      : chain(of), filter(of.prior, of.walk, 2, kStates, kChainLags, rank) {}

  void step() {
    state += filter.state_deviation();
    filter.take_state();
    filter.begin_step(kChainTime);
    state = chain.transition * state + chain.input * filter.mean();
    readings.push_back(chain.output * state);
    for (Eigen::Index k = 0; k < filter.columns(); ++k) {
      const VectorX next =
          chain.transition * filter.state_column(k) + chain.input * filter.input_column(k);
      filter.put_column(k, chain.output * next, next);
    }
    filter.end_step();
  }

  void take(int lag) {
    const std::size_t then = readings.size() - 1 - static_cast<std::size_t>(lag);
    filter.correct(lag, 0, chain.measured[then] - readings[then] - filter.reading_deviation(lag),
                   chain.variance);
  }

  void go(int late) {
    for (int k = 0; k < kChainSteps; ++k) {
      step();
      if (k >= late) take(late);
    }
    for (int lag = late - 1; lag >= 0; --lag) take(lag);
  }
};

TEST(ReducedRankFilter, IsKalmansWithAColumnForEachDimension) {
  const Chain chain;
  VectorX mean;
  MatrixX covariance;
  chain.kalman(mean, covariance);
  for (const int late : {0, kChainLags}) {
    Path run(chain, 2 + kStates + kChainLags * 2);
    run.go(late);
    EXPECT_LT((run.filter.mean() - mean.head(2)).norm(), 1e-9) << late;
    EXPECT_LT((run.state + run.filter.state_deviation() - mean.tail(kStates)).norm(), 1e-9) << late;
    EXPECT_LT((run.filter.covariance() - covariance.topLeftCorner(2, 2)).norm(), 1e-9) << late;
  }
}

// A few columns neglect little compared with the remaining uncertainty.
TEST(ReducedRankFilter, FewColumnsComeNear) {
  const Chain chain;
  VectorX mean;
  MatrixX covariance;
  chain.kalman(mean, covariance);
  const VectorX deviation = covariance.diagonal().head(2).cwiseSqrt();
  for (const auto& [rank, part] : {std::pair{6, 0.5}, std::pair{10, 0.05}}) {
    Path run(chain, rank);
    run.go(0);
    EXPECT_EQ(run.filter.columns(), rank);
    EXPECT_LT((run.filter.mean() - mean.head(2)).cwiseQuotient(deviation).norm(), part);
    const VectorX own = run.filter.covariance().diagonal().cwiseSqrt();
    EXPECT_LT((own.cwiseQuotient(deviation).array() - 1.0).abs().maxCoeff(), part) << rank;
  }
}

// At rest, readings and states depend linearly on the inputs: y = G x, s = F x.
TEST(ReducedRankFilter, AnEquilibriumIsLeastSquares) {
  const MatrixX g{{1.0, 0.5}, {0.2, -1.0}};
  const VectorX prior{{2.0, 1.0}}, variance{{0.01, 0.04}}, said{{0.7, -0.3}}, acted{{0.1, 0.2}};
  ReducedRankFilter filter(prior, VectorX::Zero(2), 2, 2, 1, 4);
  filter.begin_rest();
  for (Eigen::Index k = 0; k < filter.columns(); ++k) {
    const VectorX own = filter.input_column(k);
    filter.put_column(k, g * own, 3.0 * own);
  }
  filter.end_rest(acted);
  filter.correct(0, 0, said - g * acted - filter.reading_deviation(0), variance);
  MatrixX information = g.transpose() * variance.cwiseInverse().asDiagonal() * g;
  information.diagonal() += prior.cwiseAbs2().cwiseInverse();
  const MatrixX covariance = information.inverse();
  const VectorX mean = covariance * g.transpose() * said.cwiseQuotient(variance);
  EXPECT_LT((filter.mean() - mean).norm(), 1e-12);
  EXPECT_LT((filter.covariance() - covariance).norm(), 1e-12);
  EXPECT_LT((filter.state_deviation() - 3.0 * (mean - acted)).norm(), 1e-12);
}

// If the difference of two inputs is known, their covariance and its factor have rank one: neither
// the columns nor the correction by a measurement change the difference.
TEST(ReducedRankFilter, AnEquilibriumBeginsFromASemidefiniteCovariance) {
  const VectorX prior{{1.0, 1.0}};
  const VectorX difference{{1.0, -1.0}};
  ReducedRankFilter filter(prior, VectorX::Zero(2), 1, 1, 0, 4);
  const auto rest = [&](const VectorX& sensitivity) {
    filter.begin_rest();
    for (Eigen::Index k = 0; k < filter.columns(); ++k) {
      const VectorX own = filter.input_column(k);
      filter.put_column(k, sensitivity.transpose() * own, own.head(1));
    }
    filter.end_rest(filter.mean());
  };
  rest(difference);
  filter.correct(0, 0, VectorX::Constant(1, 0.5), VectorX::Constant(1, 1e-40));
  rest(VectorX{{1.0, 0.0}});
  for (Eigen::Index k = 0; k < filter.columns(); ++k) {
    EXPECT_LT(std::abs(difference.dot(filter.input_column(k))), 1e-12) << k;
  }
  filter.correct(0, 0, VectorX::Constant(1, 0.3), VectorX::Constant(1, 1e-4));
  EXPECT_NEAR(filter.mean()[0] - filter.mean()[1], 0.5, 1e-12);
  EXPECT_NEAR(filter.mean()[0], 0.25 + 0.3 * 0.5 / (0.5 + 1e-4), 1e-12);
}

// The first input is known exactly, so only the deviation of the second moves readings and state.
TEST(ReducedRankFilter, AnEquilibriumEndsWithASemidefiniteCovariance) {
  ReducedRankFilter filter(VectorX{{1.0, 2.0}}, VectorX::Zero(2), 1, 1, 0, 2);
  const auto rest = [&](double of_first, double of_second, const VectorX& inputs) {
    filter.begin_rest();
    for (Eigen::Index k = 0; k < filter.columns(); ++k) {
      const VectorX own = filter.input_column(k);
      const VectorX said{{of_first * own[0] + of_second * own[1]}};
      filter.put_column(k, said, 3.0 * said);
    }
    filter.end_rest(inputs);
  };
  rest(1.0, 0.0, VectorX::Zero(2));
  filter.correct(0, 0, VectorX::Constant(1, 0.5), VectorX::Constant(1, 1e-300));
  ASSERT_EQ(filter.covariance()(0, 0), 0.0);
  rest(1.0, 1.0, VectorX{{0.5, 0.2}});
  EXPECT_NEAR(filter.reading_deviation(0)[0], -0.2, 1e-12);
  EXPECT_NEAR(filter.state_deviation()[0], -0.6, 1e-12);
}

TEST(ReducedRankFilter, GoesOnFromItsNumbers) {
  const Chain chain;
  Path run(chain, 8);
  run.go(1);
  std::vector<double> numbers;
  run.filter.save(numbers);
  ReducedRankFilter other(chain.prior, chain.walk, 2, kStates, kChainLags, 8);
  std::span<const double> memory(numbers);
  ASSERT_TRUE(other.load(memory));
  EXPECT_TRUE(memory.empty());
  EXPECT_EQ(other.mean(), run.filter.mean());
  EXPECT_EQ(other.covariance(), run.filter.covariance());
  EXPECT_EQ(other.state_deviation(), run.filter.state_deviation());
  memory = std::span<const double>(numbers).first(numbers.size() - 1);
  EXPECT_FALSE(other.load(memory));
}

}  // namespace
}  // namespace sinew::estimate
