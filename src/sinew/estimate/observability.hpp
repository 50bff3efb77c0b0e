/// @file
/// Observability: the information of measurements beyond a prior.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::estimate {

/// Singular values and directions of the information of measurements, relative to the prior.
struct Observability {
  /// Singular values s of R^(-1/2) S diag(prior), (n,), descending. Along a direction with the
  /// value s, one measurement reduces the deviation to 1/sqrt(1 + s^2) of the prior's.
  VectorX singular_values;
  /// The directions, (n, n): columns of unit length, whose components are divided by their priors.
  MatrixX directions;

  /// At or below this value, the prior is at least as informative as a measurement.
  static constexpr double kUnobservable = 1.0;
};

/// Observability by one measurement. @param sensitivity (m, n) S. @param variance (m,) > 0.
/// @param prior (n,) > 0.
Observability observability(const MatrixX& sensitivity, const VectorX& variance,
                            const VectorX& prior);
/// Observability by all measurements that led to a covariance: s^2 = 1/p - 1, with p the
/// eigenvalues of diag(prior)^-1 P diag(prior)^-1; 0 if p > 1. @param covariance (n, n) P. @param
/// prior (n,) > 0.
Observability observability(const MatrixX& covariance, const VectorX& prior);

}  // namespace sinew::estimate
