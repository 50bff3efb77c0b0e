/// @file
/// Kalman filter of random-walk parameters, for delayed measurements.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::estimate {

/// Fixed-lag Kalman filter of random-walk parameters. These follow x(t + h) = x(t) + w, w normal
/// with covariance diag(walk^2) h, and x(0) is normal with mean zero and covariance diag(prior^2).
/// Measurements are y = c + S x(t_k) + v, v normal with covariance diag(variance), at any of the
/// last `lags` + 1 instants t_k, k = 0 .. lags (0: now).
///
/// The state is X = (x(t_0), x(t_1), ..., x(t_lags)). A step shifts its blocks and adds w to the
/// first. A measurement at instant k has the sensitivity (0, ..., S, ..., 0) to X: the fixed-lag
/// smoother by augmentation (Simon, Optimal State Estimation, Wiley 2006, sec. 9.3). On a linear
/// model the estimate is therefore, to rounding, that of all measurements taken at their own
/// instants, whatever the order of their arrival. Corrections use the gain K = P H^T (H P
/// H^T + R)^-1 and the Joseph form of the covariance (ibid. eq. 5.19), which stays positive
/// definite. Before the start, x was constant.
class RandomWalkFilter {
 public:
  /// @param prior (n,) > 0, in the units of x. @param walk (n,) >= 0, units of x per sqrt(s).
  /// @param lags >= 0.
  RandomWalkFilter(VectorX prior, VectorX walk, int lags);

  Eigen::Index size() const { return prior_.size(); }
  int lags() const { return lags_; }
  const VectorX& prior() const { return prior_; }
  /// Estimate at an instant from all measurements so far, (n,). @param lag 0 .. lags().
  Eigen::VectorBlock<const VectorX> mean(int lag = 0) const;
  /// Covariance of the present estimate, (n, n).
  MatrixX covariance() const;

  /// Resets the filter to the prior.
  void restart();
  /// Advances to the next instant. @param seconds > 0.
  void predict(double seconds);
  /// Corrects with a measurement at one instant. @param lag 0 .. lags(), the instant.
  /// @param sensitivity (m, n) S. @param innovation (m,) y - c - S mean(lag). @param variance
  ///   (m,) > 0.
  void correct(int lag, const MatrixX& sensitivity, const VectorX& innovation,
               const VectorX& variance);

  /// Appends the state of the filter to `memory`.
  void save(std::vector<double>& memory) const;
  /// Reads the state from the front of `memory`, and removes it there.
  /// @return false if numbers are missing.
  bool load(std::span<const double>& memory);

 private:
  VectorX prior_, walk_;  // (n,)
  int lags_;
  VectorX mean_;        // (n (lags + 1),) X
  MatrixX covariance_;  // of X
};

}  // namespace sinew::estimate
