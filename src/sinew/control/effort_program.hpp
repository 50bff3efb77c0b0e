/// @file
/// The quadratic program of a controller's step: its assembly and its solution.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sinew/control/force_rows.hpp"
#include "sinew/core/types.hpp"
#include "sinew/law/law_status.hpp"
#include "sinew/qp/elastic.hpp"
#include "sinew/qp/quadratic_program.hpp"

namespace sinew::model {
class Model;
}
namespace sinew::law {
struct ActuatorBlock;
class Response;
struct StepProblem;
}  // namespace sinew::law

namespace sinew::control {

/// The block of a controlled actuator. @param problem,response of the step.
/// @param k its index among the controlled actuators of the response.
const law::ActuatorBlock& controlled_block(const law::StepProblem& problem,
                                           const law::Response& response, Eigen::Index k);

/// Regularisation and damping of the efforts. With p the pull towards zero effort, d the damping,
/// and c the damping within the step, the objective gets the terms
///   eps/2 (d lambda^T R lambda - 2 (d - p) lambda^T R lambda_0
///          + (c - 1) (lambda - lambda_1)^T R (lambda - lambda_1)),
/// with lambda_0 the efforts of the previous step and lambda_1 the last choice of this step. At
/// lambda = lambda_0 and lambda = lambda_1 the derivative is that of p eps/2 lambda^T R lambda, so
/// neither d nor c moves a fixed point. The damping terms, with d - 1 and c - 1, scale with the
/// largest W_ea so far.
struct EffortPull {
  double epsilon = 0.0;         ///< InverseSettings::epsilon
  double to_zero = 1.0;         ///< p
  double damping = 1.0;         ///< d
  double damping_within = 1.0;  ///< c
  const VectorX& last_choice;   ///< lambda_1, (controlled,)
};

/// The quadratic program of InverseController. Its variables are the scaled efforts, followed by
/// the scaled slacks of the rows of contact forces.
class EffortProgram {
 public:
  EffortProgram() = default;
  /// @param rows of H, those of all effectors. @param weights Q, (rows,).
  /// @param actuators number of controlled actuators. @param forces the requirements on contacts.
  EffortProgram(std::vector<int> rows, VectorX weights, int actuators, ForceRows forces = {});

  /// Forms the regularisation, which is the same in all programs until the next call.
  /// @param problem of the step. @param response of the robot to start from.
  /// @param pull regularisation and damping. @param largest m, see ForceRows::begin().
  void begin(const law::StepProblem& problem, const law::Response& response, const EffortPull& pull,
             double largest);
  /// Forms the objective. @param problem,response of the step.
  /// @param residual (rows,) motion without efforts, minus the requested one.
  void form(const law::StepProblem& problem, const law::Response& response,
            const VectorX& residual);
  /// Solves the program within the limits; requires form(). @param model of the robot.
  /// @param problem,response as for form().
  /// @param effort (controlled,) N, gets the solution unless it failed.
  law::LawStatus solve(const model::Model& model, const law::StepProblem& problem,
                       const law::Response& response, std::span<double> effort);
  /// The same, within the guards of the response, too. Fails if there is no solution.
  /// @param problem,response,effort as for solve(). @param tight whether tight guards have no
  ///   slack.
  law::LawStatus solve_guarded(const law::StepProblem& problem, const law::Response& response,
                               bool tight, std::span<double> effort);

  /// Objective of the last solution, including half the weighted squares of the remaining errors.
  double foreseen() const { return foreseen_; }
  /// Multipliers of the guards in the last solve_guarded(), (guards,).
  std::span<const double> guard_multipliers() const { return guard_multipliers_; }
  /// Contribution of the pull to the objective. @param effort (controlled,) N.
  double pull_value(std::span<const double> effort) const;
  /// The largest violation of the limits by efforts and motions, relative to the size of a limit.
  /// @param problem of the step. @param motion (rows,) m. @param effort (controlled,) N.
  double excess(const law::StepProblem& problem, const VectorX& motion,
                std::span<const double> effort) const;

  const ForceRows& forces() const { return forces_; }
  /// The largest |W_ea^T Q W_ea| since forget(), for scaled efforts, J.
  double largest_asked() const { return largest_asked_; }
  /// @param value as largest_asked().
  void set_largest_asked(double value) { largest_asked_ = value; }

  /// The limits that contradict each other in the last solve(), in words; else empty.
  const std::string& conflict() const { return conflict_; }
  /// Whether a limit holds the effectors back, by the multipliers of the last solve().
  /// @param gap remaining distance from the targets, m.
  bool limit_holds(double gap) const;

  /// Forgets the active sets of the last solve().
  void reset();
  /// Forgets the active sets, the conflict and largest_asked().
  void forget();

 private:
  void form_scales(const law::StepProblem& problem, const law::Response& response);
  void form_rows(const law::StepProblem& problem, const law::Response& response);
  void regularise(const law::StepProblem& problem, const law::Response& response,
                  const EffortPull& pull);
  void form_limits(const law::StepProblem& problem, const law::Response& response,
                   qp::QuadraticProgram& program) const;
  void form_forces(qp::QuadraticProgram& program) const;
  void keep(const qp::QpResult& result);
  void write(std::span<double> effort) const;

  std::vector<int> rows_;
  VectorX weights_;
  MatrixX jacobian_;  // W_ea, scaled columns
  MatrixX weighted_;  // Q W_ea
  VectorX scale_;     // (controlled,) of each effort
  VectorX scaled_effort_;
  mutable VectorX scaled_trial_;  // of pull_value()
  std::vector<int> controlled_;   // of the response
  ForceRows forces_;
  double slack_scale_ = 1.0;  // m, of the slacks of force rows
  double largest_asked_ = 0.0;
  MatrixX pull_hessian_;   // (controlled, controlled)
  VectorX pull_gradient_;  // (controlled,)
  double left_ = 0.0;      // the objective without efforts
  double foreseen_ = 0.0;
  qp::QuadraticProgram program_;
  qp::QpSolver solver_;
  qp::QuadraticProgram guarded_;  // with rows for guards, some of them empty
  qp::QpSolver guarded_solver_;
  std::vector<double> guard_multipliers_;
  qp::ElasticSolver elastic_{0, 0};            // for steps with contradictory limits
  VectorX bound_multiplier_, row_multiplier_;  // of the program
  std::string conflict_;
};

}  // namespace sinew::control
