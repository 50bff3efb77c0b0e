/// @file
/// The filter of an estimator whose robot has inertia.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sinew/estimate/estimator_filter.hpp"
#include "sinew/estimate/reduced_rank_filter.hpp"
#include "sinew/run/state.hpp"

namespace sinew::estimate {

/// The unknowns u act through the robot's motion, with the integrator of the scene. They are the
/// only uncertain input, and the initial state is known. estimate::ReducedRankFilter estimates (u,
/// s), where s is the state of the bodies (positions, velocities, history of the integrator); after
/// each sample, the robot's s is moved to its mean.
///
/// A column (du, ds) of the covariance factor is propagated through a step by a difference of two
/// steps,
///   (dy, ds') = (F(s + e ds, u + e du) - F(s, u)) / e,   e = 0.1,
/// of the robot as it is, with its joints, contacts and drives: the derivative of the step to the
/// first order in e, and to the step's tolerance over e. One step of the filter therefore takes as
/// many steps of the robot as there are columns other than zero, and one more. A column takes two
/// steps if it moves unknowns at their bounds (slack cables) in different directions, so that no
/// single sign of e keeps all of them within their bounds.
///
/// If the robot fails along the path or along any column, the whole step is discarded: the robot
/// stays where it is, only the random walk of the unknowns adds to the covariance, and samples of
/// that instant are ignored.
///
/// Neglected: truncated columns (see ReducedRankFilter), second derivatives, and the uncertainty of
/// states outside the bodies, such as the gas in chambers and the friction memory of contacts.
class MotionFilter : public EstimatorFilter {
 public:
  /// See EstimatorFilter; the robot of the model is not quasi-static.
  MotionFilter(const EstimatorModel& model, int threads);

  void begin_settling() override;
  VectorX mean() const override { return filter_.mean(); }
  MatrixX covariance() const override { return filter_.covariance(); }
  bool knows(int lag) const override { return known_[static_cast<std::size_t>(lag)] != 0.0; }
  const VectorX& path(int lag) const override { return path_[static_cast<std::size_t>(lag)]; }
  VectorX beyond_path(int lag) const override { return filter_.reading_deviation(lag); }
  void correct(int lag, Eigen::Index first, const VectorX& innovation,
               const VectorX& variance) override;
  /// Observability by all samples so far: 1/(1 + s^2) are the eigenvalues of the covariance
  /// relative to the priors; s = 0 where these exceed 1.
  estimate::Observability observability(const VectorX& variance) const override;

 protected:
  void forget() override;
  void predict(const run::Run& run, double time_step) override;
  bool predict_rest(const run::Run& run) override;
  void save_own(std::vector<double>& memory) const override;
  bool load_own(std::span<const double>& memory) override;

 private:
  enum class Outcome { moved, path_failed, column_failed };
  // The end of the path's step, and the state from which columns start: that at the start of the
  // step, or the equilibrium.
  struct Reached {
    const run::State& start;
    VectorX numbers;
    bool settles = false;
  };

  Outcome move_all(const run::Run& run, const run::State& from, bool settles);
  // Adds (dy, ds') to `column`, (m + states,). Returns false if the robot fails.
  bool move_column(const run::Run& run, const Reached& reached, Eigen::Index k,
                   Eigen::Ref<VectorX> column);

  estimate::ReducedRankFilter filter_, settled_from_;
  std::vector<VectorX> path_;  // (lags + 1,) (m,) readings on the path, newest first
  std::vector<double> known_;  // (lags + 1,) 1: the robot made the step
};

}  // namespace sinew::estimate
