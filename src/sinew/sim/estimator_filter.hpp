/// @file
/// What an estimator concludes from samples, with a robot of its own.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/estimate/observability.hpp"

namespace sinew::sim {

struct EstimatorModel;
struct Inputs;
struct Run;
class Simulation;

/// The distribution of an estimator's unknowns, and of the readings that it expects at the instants
/// 0 .. lags back from now. Normal, by a linearisation about the path of the estimator's robot, on
/// which the unknowns act as they are estimated.
class EstimatorFilter {
 public:
  /// @param model outlives it. @param threads of the robot.
  EstimatorFilter(const EstimatorModel& model, int threads);
  virtual ~EstimatorFilter();
  EstimatorFilter(const EstimatorFilter&) = delete;
  EstimatorFilter& operator=(const EstimatorFilter&) = delete;

  /// As if the run had begun now. @param run now.
  void restart(const Run& run);
  /// To the end of the run's last step. @param run now. @param time_step s.
  void advance(const Run& run, double time_step);
  /// Whether a step is repeated after its samples, about the estimate that they led to.
  virtual bool iterates() const { return false; }
  /// The last step once more from where it began, with the unknowns as estimated now, and without
  /// what samples said since. @param run now.
  void repeat(const Run& run);
  /// Forgets what happened before, but for the distribution: what settle() begins from.
  virtual void begin_settling() = 0;
  /// From there, to an equilibrium of the run's inputs with the unknowns as estimated now. Time
  /// stands still. @param run now.
  void settle(const Run& run);

  virtual VectorX mean() const = 0;        ///< (n,)
  virtual MatrixX covariance() const = 0;  ///< (n, n)
  /// Whether a sample of an instant says something. @param lag 0 .. lags.
  virtual bool knows(int lag) const = 0;
  /// (m,) what all sensors say of the robot's path. @param lag of an instant that it knows.
  virtual const VectorX& path(int lag) const = 0;
  /// (m,) how much more they are expected to have said than that, as EstimatorModel::difference()
  /// has it. @param lag of an instant that it knows.
  virtual VectorX beyond_path(int lag) const = 0;
  /// Takes a sample of one sensor. @param lag of an instant that it knows. @param first of the
  /// sensor among the readings. @param innovation (k,) the sample less what was expected of it.
  /// @param variance (k,) > 0.
  virtual void correct(int lag, Eigen::Index first, const VectorX& innovation,
                       const VectorX& variance) = 0;
  /// What sensors tell beyond the prior. @param variance (m,) of samples; infinity: lost.
  virtual estimate::Observability observability(const VectorX& variance) const = 0;

  const Simulation& robot() const { return *robot_; }
  /// Whether the robot failed in the last step, and why where that is known.
  bool failed() const { return failed_; }
  const std::string& reason() const { return reason_; }

  /// Appends all that changes, finite numbers.
  void save(std::vector<double>& memory) const;
  /// Takes it from the front of `memory`, which it shortens. @return whether it had all numbers.
  bool load(std::span<const double>& memory);

 protected:
  /// Back to the prior.
  virtual void forget() = 0;
  virtual void predict(const Run& run, double time_step) = 0;
  /// Where it iterates.
  virtual void predict_again(const Run& /*run*/) {}
  virtual void predict_rest(const Run& run) = 0;
  virtual void save_own(std::vector<double>& memory) const = 0;
  virtual bool load_own(std::span<const double>& memory) = 0;

  const EstimatorModel& model() const { return model_; }
  Simulation& own_robot() { return *robot_; }
  /// Steps the robot, or lets it come to rest. @param run whose inputs act. @param unknowns (n,).
  /// @param settles to rest. @return whether it got there.
  bool move(const Run& run, const VectorX& unknowns, bool settles);
  /// (n,) the unknowns as they acted in the last move: a cable does not push.
  const VectorX& acted() const { return acted_; }
  /// (n,) the unknowns as they would act.
  VectorX bounded(const Run& run, const VectorX& unknowns) const;
  /// (m,) what the sensors say of the robot without errors.
  VectorX readings() const;
  /// (m,) EstimatorModel::difference() of all sensors. @param to,from (m,).
  VectorX reading_difference(const VectorX& to, const VectorX& from) const;

 private:
  Inputs inputs_of(const Run& run, const VectorX& unknowns);
  double told(const Run& run, int actuator) const;
  template <class Visitor>
  void visit_efforts(const Run& run, const VectorX& unknowns, Visitor&& visitor) const;
  void keep_time(const Run& run);

  const EstimatorModel& model_;
  std::unique_ptr<Simulation> robot_;
  VectorX acted_;
  bool failed_ = false;
  std::string reason_;
};

}  // namespace sinew::sim
