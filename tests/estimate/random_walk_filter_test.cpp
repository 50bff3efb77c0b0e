// The filter against the batch solution: a linear Gaussian problem has one posterior.
#include "sinew/estimate/random_walk_filter.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace sinew::estimate {
namespace {

constexpr int kSteps = 12, kLags = 4;
constexpr double kTime = 0.05;  // s, per step

struct Measurement {
  int step;
  MatrixX sensitivity;  // (2, 3)
  VectorX value;        // (2,)
};

struct Problem {
  VectorX prior{{1.0, 0.5, 2.0}}, walk{{0.7, 0.0, 3.0}};
  VectorX variance{{0.01, 0.04}};
  std::vector<Measurement> measurements;

  Problem() {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int step = 0; step < kSteps; ++step) {
      if (step % 3 == 1) continue;
      measurements.push_back({step, MatrixX::NullaryExpr(2, 3, [&] { return normal(random); }),
                              VectorX::NullaryExpr(2, [&] { return normal(random); })});
    }
  }

  // Batch solution for the unknowns of all steps: covariance of a random walk, prior^2 + walk^2 h
  // min(i, j), and the textbook gain P H^T (H P H^T + R)^-1.
  void posterior(VectorX& mean, MatrixX& covariance) const {
    const Eigen::Index all = 3 * kSteps;
    MatrixX p(all, all);
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const VectorX diagonal =
            prior.cwiseAbs2() + walk.cwiseAbs2() * kTime * (1.0 + std::min(i, j));
        p.block<3, 3>(3 * i, 3 * j) = diagonal.asDiagonal();
      }
    }
    const auto rows = static_cast<Eigen::Index>(2 * measurements.size());
    MatrixX h = MatrixX::Zero(rows, all);
    VectorX y(rows), r(rows);
    for (std::size_t k = 0; k < measurements.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(2 * k);
      h.block<2, 3>(row, 3 * measurements[k].step) = measurements[k].sensitivity;
      y.segment<2>(row) = measurements[k].value;
      r.segment<2>(row) = variance;
    }
    MatrixX s = h * p * h.transpose();
    s.diagonal() += r;
    const MatrixX gain = s.llt().solve(h * p).transpose();
    mean = (gain * y).tail<3>();
    covariance = (p - gain * h * p).bottomRightCorner<3, 3>();
  }

  // Filters every measurement `late` steps after it was taken, the last ones at the end.
  RandomWalkFilter filtered(int late) const {
    RandomWalkFilter filter(prior, walk, kLags);
    for (int step = 0; step < kSteps; ++step) {
      filter.predict(kTime);
      for (const Measurement& one : measurements) {
        const bool last = step == kSteps - 1 && one.step + late > step;
        if (one.step + late != step && !last) continue;
        const int lag = step - one.step;
        filter.correct(lag, one.sensitivity, one.value - one.sensitivity * filter.mean(lag),
                       variance);
      }
    }
    return filter;
  }
};

TEST(RandomWalkFilter, IsThePosteriorOfAllMeasurementsWheneverTheyArrive) {
  const Problem problem;
  VectorX mean;
  MatrixX covariance;
  problem.posterior(mean, covariance);
  for (const int late : {0, 1, 4}) {
    const RandomWalkFilter filter = problem.filtered(late);
    EXPECT_LT((filter.mean() - mean).norm(), 1e-10) << late;
    EXPECT_LT((filter.covariance() - covariance).norm(), 1e-10) << late;
  }
}

TEST(RandomWalkFilter, GoesOnFromItsNumbers) {
  const Problem problem;
  const RandomWalkFilter filter = problem.filtered(2);
  std::vector<double> numbers;
  filter.save(numbers);
  RandomWalkFilter other(problem.prior, problem.walk, kLags);
  std::span<const double> memory(numbers);
  ASSERT_TRUE(other.load(memory));
  EXPECT_TRUE(memory.empty());
  EXPECT_EQ(other.mean(2), filter.mean(2));
  EXPECT_EQ(other.covariance(), filter.covariance());
  memory = std::span<const double>(numbers).first(numbers.size() - 1);
  EXPECT_FALSE(other.load(memory));
}

}  // namespace
}  // namespace sinew::estimate
