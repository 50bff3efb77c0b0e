/// @file
/// Estimator of external forces, efforts of actuators and stiffnesses from the sensors of a run.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/estimate/observability.hpp"

namespace sinew::model {
class Model;
}

namespace sinew::run {
struct Run;
}

namespace sinew::sim {
class Simulation;
}

namespace sinew::estimate {

class EstimatorFilter;
struct EstimatorModel;

enum class EstimatorStatus {
  not_started,  ///< no sample has been used yet
  estimating,
  unobservable,    ///< sensors add less than the prior in some directions, see message()
  sensors_lost,    ///< a sensor is silent, see message(); estimation continues without it
  no_equilibrium,  ///< the estimator's robot found no equilibrium in the last step
};
inline constexpr int kEstimatorStatuses = 5;
/// "not-started", "estimating", "unobservable", "sensors-lost", "no-equilibrium".
std::string_view estimator_status_name(EstimatorStatus status);

/// A sensor counts as silent after this many of its periods without a sample.
inline constexpr double kSilentPeriods = 5.0;

/// Estimates unknown forces, efforts and stiffnesses from sensor samples, as a computer beside the
/// robot would. It knows the robot, its commands and the scene's loads except those named as
/// unknown.
///
/// It simulates a robot of its own under the estimated unknowns and compares the samples with that
/// robot's readings: see EquilibriumFilter, and MotionFilter for a robot with inertia.
///
/// Effects outside its model are attributed to the unknowns: other external forces, sensor bias,
/// and the inertia of a robot that it models as quasi-static.
class Estimator {
 public:
  /// @param model must outlive it. @param plant the model with the sensors; must outlive it. @param
  ///   threads of the estimator's robot.
  Estimator(const EstimatorModel& model, const model::Model& plant, int threads);
  ~Estimator();
  Estimator(Estimator&&) noexcept;

  const EstimatorModel& model() const { return model_; }
  /// (n,) of the components, see EstimatorModel::component_names(): N, Pa, or the logarithm of the
  /// factor of a stiffness.
  VectorX mean() const;
  MatrixX covariance() const;  ///< (n, n) of the components
  VectorX deviation() const;   ///< (n,) standard deviations of the components
  /// What sensors tell beyond the prior, see EstimatorFilter::observability(); zeros before the
  /// first step.
  const estimate::Observability& observability() const { return observability_; }
  EstimatorStatus status() const;
  /// Names the silent sensors, the unobservable directions, or the reason why there is no
  /// equilibrium; otherwise empty.
  std::string message() const;
  /// Names of the silent sensors: those without a sample for kSilentPeriods or longer than their
  /// timeout.
  std::vector<std::string> lost() const;
  /// Directions determined by the prior alone, as text: "0.98 hand.z - 0.2 hand.x".
  std::vector<std::string> unobservable() const;
  /// Number of samples that arrived too late to be used.
  long dropped() const { return whole<long>(dropped_); }
  /// The estimator's robot, under the unknowns as estimated before the last step.
  const sim::Simulation& robot() const;

  /// Starts afresh, as if the run began now.
  void begin(const run::Run& run);
  /// Updates the estimate after a step and its samples.
  void advance(const run::Run& run);
  /// Updates the estimate after a search for an equilibrium: the iterated filter (Simon 2006, sec.
  /// 13.3.1) on the samples taken there. Time does not advance.
  void settle(const run::Run& run);

  /// Appends its state as finite numbers.
  void save(std::vector<double>& memory) const;
  /// Reads its state from the front of `memory`, which is shortened. @return whether `memory` held
  /// a complete state of such an estimator; if not, call begin().
  bool load(std::span<const double>& memory);

 private:
  void forget();
  void correct(const run::Run& run);
  template <class Predictor>
  void iterate(const run::Run& run, int rounds, double settled, Predictor&& predictor);
  void note_silence(const run::Run& run);
  void observe();
  template <class Self, class Visitor>
  static void visit_memory(Self& self, Visitor&& visitor);

  const EstimatorModel& model_;
  const model::Model& plant_;
  std::unique_ptr<EstimatorFilter> filter_;
  std::vector<double> used_;    // (sensors,) s, of the sample that was used last; -1: none
  std::vector<double> silent_;  // (sensors,) 1: lost
  double dropped_ = 0.0, started_ = 0.0;
  estimate::Observability observability_;
};

}  // namespace sinew::estimate
