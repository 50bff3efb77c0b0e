/// @file
/// What measurements tell beyond a prior.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::estimate {

/// What measurements tell beyond the prior.
struct Observability {
  /// (n,) s of R^(-1/2) S diag(prior), falling: along a direction of value s one measurement lowers
  /// the deviation to 1/sqrt(1 + s^2) of the prior's.
  VectorX singular_values;
  /// (n, n) the directions, columns of unit length, in components over their priors.
  MatrixX directions;

  /// Of this value and below, the prior says as much as a measurement, or more.
  static constexpr double kUnobservable = 1.0;
};

/// @param sensitivity (m, n) S. @param variance (m,) > 0. @param prior (n,) > 0.
Observability observability(const MatrixX& sensitivity, const VectorX& variance,
                            const VectorX& prior);
/// Of all measurements that have led to a covariance: s^2 = 1/p - 1, p the eigenvalues of
/// diag(prior)^-1 P diag(prior)^-1; 0 where p > 1. @param covariance (n, n) P. @param prior (n,) >
/// 0.
Observability observability(const MatrixX& covariance, const VectorX& prior);

}  // namespace sinew::estimate
