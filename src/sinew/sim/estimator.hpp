/// @file
/// What a run concludes from its sensors: forces from outside, efforts of actuators, stiffness.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/estimate/observability.hpp"

namespace sinew::sim {

class EstimatorFilter;
struct EstimatorModel;
class Model;
struct Run;
class Simulation;

enum class EstimatorStatus {
  not_started,  ///< no sample was used yet
  estimating,
  unobservable,    ///< along some directions sensors tell less than the prior: see its message
  sensors_lost,    ///< a sensor is silent: see its message; the estimate goes on without it
  no_equilibrium,  ///< the estimator's robot found none in the last step
};
inline constexpr int kEstimatorStatuses = 5;
/// "not-started", "estimating", "unobservable", "sensors-lost", "no-equilibrium".
std::string_view estimator_status_name(EstimatorStatus status);

/// A sensor is silent after as many of its periods without a sample.
inline constexpr double kSilentPeriods = 5.0;

/// A computer beside the robot, which knows the robot, its commands and the loads of the scene but
/// those that are named as unknown, and which gets the samples of sensors.
///
/// It moves a robot of its own with the unknowns as it estimates them, and compares samples with
/// what its sensors say: see EquilibriumFilter, and MotionFilter for a robot with inertia.
///
/// What is not known to it is taken for the unknowns: other forces from outside, the bias of
/// sensors, and the inertia of a robot that it takes for quasi-static.
class Estimator {
 public:
  /// @param model outlives it. @param plant that has the sensors. @param threads of the estimator's
  /// robot.
  Estimator(const EstimatorModel& model, const Model& plant, int threads);
  ~Estimator();
  Estimator(Estimator&&) noexcept;

  const EstimatorModel& model() const { return model_; }
  /// (n,) N or Pa, and of a stiffness the logarithm of its factor, see
  /// EstimatorModel::component_names().
  VectorX mean() const;
  MatrixX covariance() const;  ///< (n, n) of them
  VectorX deviation() const;   ///< (n,) of them
  /// What sensors tell beyond the prior, see EstimatorFilter::observability(); zeros before the
  /// first step.
  const estimate::Observability& observability() const { return observability_; }
  EstimatorStatus status() const;
  /// Which sensors are silent, what they do not observe, or why there is no equilibrium; else
  /// empty.
  std::string message() const;
  /// Names of sensors that are silent: without a sample for kSilentPeriods, or for their timeout.
  std::vector<std::string> lost() const;
  /// Directions that the prior alone decides, in words: "0.98 hand.z - 0.2 hand.x".
  std::vector<std::string> unobservable() const;
  /// Samples that came later than the estimator can take.
  long dropped() const { return static_cast<long>(dropped_); }
  /// The robot as the estimator sees it, with the unknowns that it had estimated before the last
  /// step.
  const Simulation& robot() const;

  /// As if the run had begun now.
  void begin(const Run& run);
  /// After a step and its samples.
  void advance(const Run& run);
  /// After a search for an equilibrium: the iterated filter (Simon 2006, sec. 13.3.1) on the
  /// samples that were taken there. Time stands still.
  void settle(const Run& run);

  /// Appends all that changes, finite numbers.
  void save(std::vector<double>& memory) const;
  /// Takes it from the front of `memory`, which it shortens. @return whether it had all numbers of
  /// such an estimator; else it has to begin().
  bool load(std::span<const double>& memory);

 private:
  void forget();
  void correct(const Run& run);
  template <class Predictor>
  void iterate(const Run& run, int rounds, double settled, Predictor&& predictor);
  void note_silence(const Run& run);
  void observe();
  template <class Self, class Visitor>
  static void visit_memory(Self& self, Visitor&& visitor);

  const EstimatorModel& model_;
  const Model& plant_;
  std::unique_ptr<EstimatorFilter> filter_;
  std::vector<double> used_;    // (sensors,) s, of the sample that was used last; -1: none
  std::vector<double> silent_;  // (sensors,) 1: lost
  double dropped_ = 0.0, started_ = 0.0;
  estimate::Observability observability_;
};

}  // namespace sinew::sim
