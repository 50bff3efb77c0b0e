/// @file
/// Reduced-rank Kalman filter of a model's state and of unknown random-walk inputs.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::estimate {

/// Reduced-rank square root Kalman filter of unknown inputs and of a model's state (Verlaan &
/// Heemink, Stoch. Hydrol. Hydraul. 11 (1997) 349-368). Inputs x, as in RandomWalkFilter, act on a
/// model that advances a state s and predicts readings y. The filter's state is Z = (x, y(t_0),
/// ..., y(t_lags), s(t_0)), t_k k steps before now. Since it contains the readings of earlier
/// steps, a delayed measurement is one of its components (see RandomWalkFilter). The covariance is
/// L L^T, where L has few columns, which the caller propagates through the model one by one. The
/// model itself follows a path; the filter holds the means of y and s as deviations from this path.
///
/// After each step, the columns are rotated so that the first n span the inputs. The others, in
/// which inputs have no part, are truncated to the principal ones of all numbers over their
/// standard deviations. The covariance of the inputs, with themselves and with everything else, is
/// therefore kept in full; truncation only reduces that of the state.
///
/// On a linear model, with as many columns as the state has dimensions, it is the Kalman filter of
/// (x, s) to rounding.
class ReducedRankFilter {
 public:
  /// @param prior (n,) > 0, in the units of the inputs. @param walk (n,) >= 0, these units per
  ///   sqrt(s).
  /// @param readings m. @param states size of s. @param lags >= 0.
  /// @param rank >= n, number of columns after a step.
  ReducedRankFilter(VectorX prior, VectorX walk, Eigen::Index readings, Eigen::Index states,
                    int lags, Eigen::Index rank);

  Eigen::Index size() const { return prior_.size(); }
  int lags() const { return lags_; }
  const VectorX& prior() const { return prior_; }

  VectorX mean() const { return mean_.head(size()); }  ///< (n,) of the inputs
  MatrixX covariance() const;                          ///< (n, n) of the inputs
  VectorX reading_deviation(int lag) const;  ///< (m,) mean minus path. @param lag of the reading.
  VectorX state_deviation() const;           ///< (states,) mean minus path
  /// Moves the path of the state to its mean. reading_deviation() of earlier instants stays.
  void take_state() { mean_.tail(states_).setZero(); }
  /// Sets the mean of inputs that reached a bound. @param inputs (n,) their mean from now on.
  void put_mean(const VectorX& inputs) { mean_.head(size()) = inputs; }

  /// Resets the inputs to the prior; the state is known.
  void restart();
  /// Begins a step: the random walk of the inputs adds n columns, and readings become one step
  /// older. The caller must then replace the columns' present state and reading. @param
  /// seconds > 0.
  void begin_step(double seconds);
  /// Begins an equilibrium: n columns, of the inputs only; earlier readings are discarded.
  void begin_rest();
  Eigen::Index columns() const { return factor_.cols(); }
  VectorX input_column(Eigen::Index column) const { return factor_.col(column).head(size()); }
  VectorX state_column(Eigen::Index column) const { return factor_.col(column).tail(states_); }
  /// Sets the result of the model for a column. @param column below columns(). @param reading (m,)
  /// and
  /// @param state (states,) present values.
  void put_column(Eigen::Index column, const VectorX& reading, const VectorX& state);
  /// Ends a step whose path began at the mean. Truncates the columns to the rank.
  void end_step();
  /// Ends an equilibrium. @param inputs (n,) that acted on the path: the mean of the state differs
  /// from the path as far as the mean of the inputs differs from these.
  void end_rest(const VectorX& inputs);

  /// Corrects with a measurement of readings at one instant. @param lag 0 .. lags().
  /// @param first of the readings. @param innovation (k,) measurement minus path and
  ///   reading_deviation(). @param variance (k,) > 0.
  void correct(int lag, Eigen::Index first, const VectorX& innovation, const VectorX& variance);

  /// Appends the state of the filter to `memory`.
  void save(std::vector<double>& memory) const;
  /// Reads the state from the front of `memory`, and removes it there.
  /// @return false if numbers are missing.
  bool load(std::span<const double>& memory);

 private:
  Eigen::Index reading_row(int lag) const { return size() + lag * readings_; }
  Eigen::Index rows() const { return mean_.size(); }
  void cut();

  VectorX prior_, walk_;  // (n,)
  Eigen::Index readings_, states_, rank_;
  int lags_;
  VectorX mean_;    // (rows,) x, then deviations of y and s from the path
  MatrixX factor_;  // (rows, columns) L
};

}  // namespace sinew::estimate
