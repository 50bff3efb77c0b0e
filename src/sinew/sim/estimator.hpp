/// @file
/// Forces from outside that a run concludes from its sensors.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/estimate/random_walk_filter.hpp"

namespace sinew::sim {

struct EstimatorModel;
struct EstimatorSensor;
struct Inputs;
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

/// A computer beside the robot, which knows the robot, its commands and the loads of the scene but
/// those that are named as unknown, and which gets the samples of sensors.
///
/// It steps a robot of its own, quasi-static, with the estimated forces u in place of the unknown
/// ones: the readings h_k(u_k) and their derivative S_k = dh_k/du of step k are those of this step
/// and its linearisation (StepResponse). With x the forces, which wander at random,
///   y = h_k(u_k) + S_k (x_k - u_k) + v
/// is what a sample of step k says; estimate::RandomWalkFilter takes it, with u_k = the estimate
/// before step k. This is the extended Kalman filter (Simon, Optimal State Estimation, Wiley 2006,
/// sec. 13.2) of equilibria along a random walk; a sample that comes late counts for the step in
/// which it was taken. Step and sample agree to the step's tolerance, and S to the change of the
/// tangent by the last Newton correction.
///
/// Of an orientation, y - h is the rotation vector of R_y R_h^T.
///
/// What is not known to it is taken for the forces: other forces from outside, inertia, and the
/// bias of sensors.
class Estimator {
 public:
  /// @param model outlives it. @param plant that has the sensors. @param threads of the estimator's
  /// robot.
  Estimator(const EstimatorModel& model, const Model& plant, int threads);
  ~Estimator();
  Estimator(Estimator&&) noexcept;

  const EstimatorModel& model() const { return model_; }
  /// (n,) N, n = 3 a force.
  VectorX mean() const { return filter_.mean(); }
  MatrixX covariance() const { return filter_.covariance(); }  ///< (n, n) N^2
  VectorX deviation() const;                                   ///< (n,) N
  /// Of all sensors together that are not lost, at the last step; zeros before the first.
  const estimate::Observability& observability() const { return observability_; }
  EstimatorStatus status() const;
  /// Which sensors are silent, what they do not observe, or why there is no equilibrium; else
  /// empty.
  std::string message() const;
  /// Names of sensors that are silent: without a sample for five periods, or for their timeout.
  std::vector<std::string> lost() const;
  /// Directions that the prior alone decides, in words: "0.98 hand.z - 0.2 hand.x".
  std::vector<std::string> unobservable() const;
  /// Samples that came later than the estimator can take.
  long dropped() const { return static_cast<long>(dropped_); }
  /// The robot as the estimator sees it, with the force that it had estimated before the last step.
  const Simulation& robot() const { return *robot_; }

  /// As if the run had begun now.
  void begin(const Run& run);
  /// After a step and its samples.
  void advance(const Run& run);
  /// After a search for an equilibrium: the iterated filter (ibid. sec. 13.3.1) on the samples that
  /// were taken there. Time stands still.
  void settle(const Run& run);

  /// Appends all that changes, finite numbers.
  void save(std::vector<double>& memory) const;
  /// Takes it from the front of `memory`, which it shortens. @return whether it had all numbers of
  /// such an estimator; else it has to begin().
  bool load(std::span<const double>& memory);

 private:
  // What one step of the estimator's robot says.
  struct Instant {
    bool known = false;
    VectorX force;        // (n,) N, that acted
    VectorX readings;     // (m,) of all sensors
    MatrixX sensitivity;  // (m, n)
  };

  void forget();
  void keep_time(const Run& run);
  Inputs inputs_of(const Run& run) const;
  void take_up(const Run& run, bool settles);
  void remember();
  MatrixX sensitivity() const;
  VectorX difference(const EstimatorSensor& sensor, const VectorX& said,
                     const VectorX& expected) const;
  void correct(const Run& run);
  void note_silence(const Run& run);
  void observe();
  template <class Self, class Visitor>
  static bool visit_memory(Self& self, Visitor&& visitor);

  const EstimatorModel& model_;
  const Model& plant_;
  std::unique_ptr<Simulation> robot_;
  estimate::RandomWalkFilter filter_;
  std::vector<int> controlled_;    // actuators of the forces
  std::vector<Instant> instants_;  // (lags + 1,) from now back
  std::vector<double> used_;       // (sensors,) s, of the sample that was used last; -1: none
  std::vector<double> silent_;     // (sensors,) 1: lost
  double dropped_ = 0.0;
  bool started_ = false, stopped_ = false;
  std::string reason_;  // of no equilibrium, in this process
  estimate::Observability observability_;
};

}  // namespace sinew::sim
