/// @file
/// Kalman filter of numbers that wander at random, for measurements that arrive late.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::estimate {

/// x(t + h) = x(t) + w, w normal of covariance diag(walk^2) h, x(0) normal of mean zero and
/// covariance diag(prior^2), and measurements y = c + S x(t_k) + v, v normal of covariance
/// diag(variance), of any of the last `lags` + 1 instants t_k, k = 0 .. lags (0: now).
///
/// The state is X = (x(t_0), x(t_1), ..., x(t_lags)). A step shifts its blocks and adds w to the
/// first; a measurement of instant k has the sensitivity (0, ..., S, ..., 0) to X: the fixed-lag
/// smoother by augmentation (Simon, Optimal State Estimation, Wiley 2006, sec. 9.3). On a linear
/// model the estimate is therefore, to rounding, that of all measurements put where they belong,
/// whatever the order of their arrival. Corrections take the gain K = P H^T (H P H^T + R)^-1 and
/// the covariance in Joseph's form (ibid. eq. 5.19), which stays positive definite. Before the
/// start x stood still.
class RandomWalkFilter {
 public:
  /// @param prior (n,) > 0, in the numbers' units. @param walk (n,) >= 0, their units over sqrt(s).
  /// @param lags >= 0.
  RandomWalkFilter(VectorX prior, VectorX walk, int lags);

  Eigen::Index size() const { return prior_.size(); }
  int lags() const { return lags_; }
  const VectorX& prior() const { return prior_; }
  /// (n,) the estimate of an instant from all measurements so far. @param lag 0 .. lags().
  Eigen::VectorBlock<const VectorX> mean(int lag = 0) const;
  /// (n, n) of the estimate of now.
  MatrixX covariance() const;

  /// Back to the prior.
  void restart();
  /// To the next instant. @param seconds > 0.
  void predict(double seconds);
  /// Takes a measurement of one instant. @param lag 0 .. lags(), which instant. @param sensitivity
  /// (m, n) S. @param innovation (m,) y - c - S mean(lag). @param variance (m,) > 0.
  void correct(int lag, const MatrixX& sensitivity, const VectorX& innovation,
               const VectorX& variance);

  /// Appends all that changes.
  void save(std::vector<double>& memory) const;
  /// Takes it from the front of `memory`, which it shortens. @return whether it had all numbers.
  bool load(std::span<const double>& memory);

 private:
  VectorX prior_, walk_;  // (n,)
  int lags_;
  VectorX mean_;        // (n (lags + 1),) X
  MatrixX covariance_;  // of X
};

}  // namespace sinew::estimate
