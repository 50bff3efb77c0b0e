/// @file
/// Kalman filter of a model's state and of unknown inputs that wander at random, with a covariance
/// of few columns.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::estimate {

/// Inputs x, as in RandomWalkFilter, act on a model that steps a state s and says readings y. The
/// filter's state is Z = (x, y(t_0), ..., y(t_lags), s(t_0)), t_k k steps before now: with the
/// readings of earlier steps in it, a measurement that comes late is one of its components (see
/// RandomWalkFilter). The covariance is L L^T, L with few columns, which the caller takes through
/// the model one by one (Verlaan & Heemink, Stoch. Hydrol. Hydraul. 11 (1997) 349-368, the
/// reduced-rank square root filter). The model itself follows a path; the filter holds the means of
/// y and s as deviations from it.
///
/// After each step columns are rotated so that the first n span the inputs, and the others, in
/// which inputs have no part, are cut to the principal ones of all numbers over their standard
/// deviations. The covariance of the inputs, with themselves and with all else, is therefore kept
/// whole; what is cut lessens that of the state alone.
///
/// On a linear model, and with as many columns as the state has dimensions, it is the Kalman filter
/// of (x, s) to rounding.
class ReducedRankFilter {
 public:
  /// @param prior (n,) > 0, in the inputs' units. @param walk (n,) >= 0, their units over sqrt(s).
  /// @param readings m. @param states numbers of s. @param lags >= 0. @param rank >= n, columns
  /// after a step.
  ReducedRankFilter(VectorX prior, VectorX walk, Eigen::Index readings, Eigen::Index states,
                    int lags, Eigen::Index rank);

  Eigen::Index size() const { return prior_.size(); }
  int lags() const { return lags_; }
  const VectorX& prior() const { return prior_; }

  VectorX mean() const { return mean_.head(size()); }  ///< (n,) of the inputs
  MatrixX covariance() const;                          ///< (n, n) of the inputs
  VectorX reading_deviation(int lag) const;            ///< (m,) mean less path. @param lag of it.
  VectorX state_deviation() const;                     ///< (states,) mean less path
  /// Lays the path through the mean: what reading_deviation() was of the earlier instants stays.
  void take_state() { mean_.tail(states_).setZero(); }
  /// Where inputs reached a bound. @param inputs (n,) their mean from now on.
  void put_mean(const VectorX& inputs) { mean_.head(size()) = inputs; }

  /// Back to the prior, the state being known.
  void restart();
  /// Begins a step: the inputs wander, which adds n columns, and readings are one step older.
  /// The columns of state and reading now have to be replaced. @param seconds > 0.
  void begin_step(double seconds);
  /// Begins an equilibrium: n columns, of the inputs alone; earlier readings are forgotten.
  void begin_rest();
  Eigen::Index columns() const { return factor_.cols(); }
  VectorX input_column(Eigen::Index column) const { return factor_.col(column).head(size()); }
  VectorX state_column(Eigen::Index column) const { return factor_.col(column).tail(states_); }
  /// What the model makes of a column. @param column of columns(). @param reading (m,) @param state
  /// (states,): now.
  void put_column(Eigen::Index column, const VectorX& reading, const VectorX& state);
  /// Ends a step whose path began at the mean. Cuts the columns to the rank.
  void end_step();
  /// Ends an equilibrium. @param inputs (n,) that acted on the path: the mean differs from it as
  /// far as that of the inputs does.
  void end_rest(const VectorX& inputs);

  /// Takes a measurement of readings of one instant. @param lag 0 .. lags(). @param first of the
  /// readings. @param innovation (k,) measurement less path and reading_deviation(). @param
  /// variance (k,) > 0.
  void correct(int lag, Eigen::Index first, const VectorX& innovation, const VectorX& variance);

  /// Appends all that changes.
  void save(std::vector<double>& memory) const;
  /// Takes it from the front of `memory`, which it shortens. @return whether it had all numbers.
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
