/// @file
/// Interface of an estimator's filter, which runs a robot of its own.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/estimate/observability.hpp"

namespace sinew::run {
struct Inputs;
struct Run;
}  // namespace sinew::run

namespace sinew::sim {
class Simulation;
}

namespace sinew::estimate {

struct EstimatorModel;

/// The joint normal distribution of an estimator's unknowns and of the expected readings at the
/// last lags + 1 instants (lag 0 is now), linearised about the path of the estimator's robot under
/// the estimated unknowns.
class EstimatorFilter {
 public:
  /// @param model must outlive it. @param threads of the robot.
  EstimatorFilter(const EstimatorModel& model, int threads);
  virtual ~EstimatorFilter();
  EstimatorFilter(const EstimatorFilter&) = delete;
  EstimatorFilter& operator=(const EstimatorFilter&) = delete;

  /// Starts afresh, as if the run began now. @param run at its present time.
  void restart(const run::Run& run);
  /// Predicts to the end of the run's last step. @param run at its present time.
  /// @param time_step s.
  void advance(const run::Run& run, double time_step);
  /// Whether each step is repeated about the estimate that was corrected with its samples.
  virtual bool iterates() const { return false; }
  /// Repeats the last step from its initial state with the present estimate of the unknowns, and
  /// discards the corrections since advance(). If the robot fails, they are kept. Call it only if
  /// advance() succeeded. @param run at its present time. @return whether the robot succeeded.
  bool repeat(const run::Run& run);
  /// Forgets what happened before, but for the distribution: what settle() begins from.
  virtual void begin_settling() = 0;
  /// Predicts from there to an equilibrium under the run's inputs and the unknowns as estimated
  /// now. Time does not advance. If the robot fails after an earlier equilibrium since
  /// begin_settling(), that one and the corrections are kept. @param run at its present time.
  /// @return whether the robot succeeded.
  bool settle(const run::Run& run);

  virtual VectorX mean() const = 0;        ///< (n,)
  virtual MatrixX covariance() const = 0;  ///< (n, n)
  /// Whether samples of an instant can be used. @param lag 0 .. lags.
  virtual bool knows(int lag) const = 0;
  /// (m,) readings of all sensors on the robot's path. @param lag of a known instant.
  virtual const VectorX& path(int lag) const = 0;
  /// (m,) expected readings minus those on the path, in the sense of EstimatorModel::difference().
  /// @param lag of a known instant.
  virtual VectorX beyond_path(int lag) const = 0;
  /// Updates the distribution by a sample of one sensor. @param lag of a known instant.
  /// @param first index of the sensor's first component among the readings.
  /// @param innovation (k,) sample minus its expected value. @param variance (k,) > 0.
  virtual void correct(int lag, Eigen::Index first, const VectorX& innovation,
                       const VectorX& variance) = 0;
  /// Information of the sensors beyond the prior. @param variance (m,) of samples; infinity: lost.
  virtual estimate::Observability observability(const VectorX& variance) const = 0;

  const sim::Simulation& robot() const { return *robot_; }
  /// Whether the last step or equilibrium has no result since the robot failed, and the reason if
  /// it is known.
  bool failed() const { return failed_; }
  const std::string& reason() const { return reason_; }

  /// Appends its state as finite numbers.
  void save(std::vector<double>& memory) const;
  /// Reads its state from the front of `memory`, which is shortened.
  /// @return whether the state was complete.
  bool load(std::span<const double>& memory);

 protected:
  /// Resets the distribution to the prior.
  virtual void forget() = 0;
  virtual void predict(const run::Run& run, double time_step) = 0;
  /// Implements repeat() if iterates().
  virtual bool predict_again(const run::Run& /*run*/) { return false; }
  /// Implements settle().
  virtual bool predict_rest(const run::Run& run) = 0;
  virtual void save_own(std::vector<double>& memory) const = 0;
  virtual bool load_own(std::span<const double>& memory) = 0;

  const EstimatorModel& model() const { return model_; }
  sim::Simulation& own_robot() { return *robot_; }
  /// Makes a step of the robot, or finds its equilibrium. @param run whose inputs act.
  /// @param unknowns (n,). @param settles whether to find the equilibrium.
  /// @return whether it succeeded.
  bool move(const run::Run& run, const VectorX& unknowns, bool settles);
  /// (n,) the unknowns as they acted in the last move, within the limits of their actuators: a
  /// cable cannot push.
  const VectorX& acted() const { return acted_; }
  /// (n,) the unknowns as they would act, see acted().
  VectorX bounded(const run::Run& run, const VectorX& unknowns) const;
  /// (m,) what the sensors say of the robot without errors.
  VectorX readings() const;
  /// (m,) EstimatorModel::difference() for all sensors. @param to,from (m,) readings.
  VectorX reading_difference(const VectorX& to, const VectorX& from) const;

 private:
  run::Inputs inputs_of(const run::Run& run, const VectorX& unknowns);
  double told(const run::Run& run, int actuator) const;
  template <class Visitor>
  void visit_efforts(const run::Run& run, const VectorX& unknowns, Visitor&& visitor) const;
  void keep_time(const run::Run& run);
  bool end_round(const run::Run& run, bool succeeded);

  const EstimatorModel& model_;
  std::unique_ptr<sim::Simulation> robot_;
  VectorX acted_;
  bool failed_ = false;
  std::string reason_;
};

}  // namespace sinew::estimate
