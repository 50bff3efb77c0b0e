/// @file
/// Inverse control by quadratic programming: which efforts take the effectors to their targets?
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "sinew/inverse/target.hpp"
#include "sinew/qp/elastic.hpp"
#include "sinew/qp/quadratic_program.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::inverse {

/// Which efforts are preferred among those that serve the targets equally well.
enum class Regularisation {
  change,  ///< those of the step before: no bias of the effector at rest
  effort,  ///< zero efforts, as published: biases the effector by about epsilon
};

/// What is asked of one effector.
struct Task {
  int effector = 0;
  Target target;
  /// One for all rows of the effector, or one each; >= 0. Squared distances are multiplied by it.
  std::vector<double> weights = {1.0};
};

struct InverseSettings {
  std::vector<Task> tasks;
  std::vector<int> actuators;  ///< that the controller owns; empty: all
  Regularisation regularisation = Regularisation::change;
  /// eps = epsilon |W_ea^T Q W_ea|_inf / |W_aa|_inf weighs the regularisation (Coevoet, Escande and
  /// Duriez, IEEE RA-L 2(3), 2017, section III-C, with 1e-3 and Regularisation::effort).
  double epsilon = 1e-3;
  /// With Regularisation::change: share of it that still draws efforts to zero, so that cables that
  /// pull against each other let go in time.
  double relaxation = 1e-2;
  /// A target farther away than this part of the robot's size is approached by steps of that
  /// length, since beyond it the linearisation is worth nothing.
  double largest_step = 0.02;
  /// m (or rad): an effector this near to its target is on target.
  double tolerance = 1e-4;
};

/// How the last step served the targets.
enum class InverseStatus {
  on_target,        ///< every effector within the tolerance, as the linearisation sees it
  rate_limited,     ///< still on the way: limits on rates (or largest_step) bind
  out_of_reach,     ///< as near as limits allow; the target is beyond
  limits_conflict,  ///< limits contradict each other in this step; the least violation was taken
};
/// "on-target", "rate-limited", "out-of-reach", "limits-conflict".
std::string_view inverse_status_name(InverseStatus status);

/// Owns its actuators from construction to detach() or destruction. In each step of the simulation,
/// with e the rows of effectors, a those of actuators and Q the weights,
///   min 1/2 |W_ea lambda + delta_e - target|_Q^2 + eps/2 (lambda - lambda_0)^T W_aa (lambda -
///   lambda_0) s.t. limits on lambda, and on delta_a = delta_free + W_aa lambda, rates folded in,
/// where lambda_0 is the last step's effort (Regularisation::change) or zero. Actuators that it
/// does not own obey their commands (equality rows, but for a motion that would take more effort
/// than the limits allow).
class InverseController : public sim::Law {
 public:
  /// @param simulation must outlive the controller. @param settings see there.
  /// Throws Error: no-effectors, no-actuators, actuator-owned, wrong-length (weights),
  /// out-of-range.
  InverseController(sim::Simulation& simulation, InverseSettings settings);
  ~InverseController() override;
  InverseController(const InverseController&) = delete;
  InverseController& operator=(const InverseController&) = delete;

  /// Solves and advances the simulation by one step.
  InverseStatus step();
  void detach();

  /// Replaces a task's target. @param task position in the settings. @param target (3,) m or rad,
  /// or
  ///   a path over the simulation's time.
  void set_target(int task, Target target);

  const InverseSettings& settings() const { return settings_; }
  InverseStatus status() const { return status_; }
  /// Efforts (actuators,) N that the controller chose last, in the order of settings().actuators.
  const VectorX& efforts() const { return efforts_; }
  /// Distance of a task's effector from its target now, along the effector's directions; m or rad.
  double error(int task) const;
  /// The largest error() of all tasks.
  double error() const;
  /// What the last step's linearisation left, m or rad.
  double predicted_error() const { return predicted_error_; }

  sim::LawStatus solve(const sim::LawProblem& problem, std::span<double> effort) override;
  double violation(const sim::LawProblem& problem, std::span<const double> effort) const override;
  void reset() override;

 private:
  void check_settings();
  void form_residual(const sim::LawProblem& problem);
  void form_objective(const sim::LawProblem& problem, std::span<const double> effort);
  void form_limits(const sim::LawProblem& problem);
  sim::LawStatus solve_program(const sim::LawProblem& problem);
  bool settle_passive_rows(const sim::LawProblem& problem);
  void judge(const sim::LawProblem& problem, sim::LawStatus status);

  sim::Simulation& simulation_;
  InverseSettings settings_;
  bool attached_ = false;

  std::vector<int> effector_rows_;  // rows of H, all tasks one after the other
  VectorX row_weights_;             // Q, as many
  MatrixX jacobian_;                // W_ea, scaled columns
  MatrixX weighted_;                // Q W_ea
  VectorX residual_;                // delta_free_e - target, shortened to largest_step
  VectorX goal_;                    // what delta of a task's rows should be
  VectorX scale_;                   // of each actuator's effort
  VectorX scaled_effort_;
  enum class Passive : char { held, at_least, at_most };  // by its motion, or by a limit
  std::vector<Passive> passive_;                          // of rows whose motion is commanded
  bool shortened_ = false;
  qp::QuadraticProgram program_;
  qp::QpSolver solver_;
  qp::ElasticSolver elastic_{0, 0};  // for steps in which limits contradict each other
  VectorX efforts_;
  double predicted_error_ = 0.0;
  InverseStatus status_ = InverseStatus::on_target;
};

}  // namespace sinew::inverse
