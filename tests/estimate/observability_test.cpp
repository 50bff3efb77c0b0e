#include "sinew/estimate/observability.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "sinew/estimate/random_walk_filter.hpp"

namespace sinew::estimate {
namespace {

// A measurement of a direction with singular value s reduces its standard deviation by the factor
// 1/sqrt(1 + s^2); compares the prediction with the resulting covariance.
TEST(Observability, TellsWhatAMeasurementLowers) {
  const VectorX prior{{2.0, 0.5, 1.0}}, variance{{0.04, 0.01}};
  const MatrixX sensitivity{{1.0, 2.0, 0.0}, {0.5, -1.0, 0.0}};
  const Observability found = observability(sensitivity, variance, prior);
  EXPECT_EQ(found.singular_values[2], 0.0);
  RandomWalkFilter filter(prior, VectorX::Zero(3), 0);
  filter.correct(0, sensitivity, VectorX::Zero(2), variance);
  const MatrixX scaled =
      prior.cwiseInverse().asDiagonal() * filter.covariance() * prior.cwiseInverse().asDiagonal();
  const Observability left = observability(filter.covariance(), prior);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double value = found.singular_values[k];
    const VectorX direction = found.directions.col(k);
    EXPECT_NEAR(direction.dot(scaled * direction), 1.0 / (1.0 + std::pow(value, 2)), 1e-12);
    EXPECT_NEAR(left.singular_values[k], value, 1e-6 + 1e-9 * value);
    EXPECT_NEAR(std::abs(left.directions.col(k).dot(direction)), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace sinew::estimate
