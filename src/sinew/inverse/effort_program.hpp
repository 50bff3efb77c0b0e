/// @file
/// The quadratic program of a controller's step: its assembly and its solution.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/inverse/force_rows.hpp"
#include "sinew/qp/elastic.hpp"
#include "sinew/qp/quadratic_program.hpp"
#include "sinew/step/law_status.hpp"

namespace sinew::sim {
class Model;
}
namespace sinew::step {
struct ActuatorBlock;
class Response;
struct StepProblem;
}  // namespace sinew::step

namespace sinew::inverse {

/// The block of a controlled actuator. @param problem,response of the step. @param k its position
/// among those of the response.
const step::ActuatorBlock& controlled_block(const step::StepProblem& problem,
                                            const step::Response& response, Eigen::Index k);

/// What efforts are drawn to. With p the pull to zero efforts, d the damping, and c that within the
/// step, the objective gets
///   eps/2 (d lambda^T R lambda - 2 (d - p) lambda^T R lambda_0
///          + (c - 1) (lambda - lambda_1)^T R (lambda - lambda_1)),
/// with lambda_0 the efforts of the step before and lambda_1 the step's last choice. At lambda =
/// lambda_0 and lambda = lambda_1 the derivative is that of p eps/2 lambda^T R lambda: neither d
/// nor c moves a fixed point. Damping, d - 1 and c - 1, is of the size of the largest W_ea so far.
struct EffortPull {
  double epsilon = 0.0;         ///< InverseSettings::epsilon
  double to_zero = 1.0;         ///< p
  double damping = 1.0;         ///< d
  double damping_within = 1.0;  ///< c
  const VectorX& last_choice;   ///< lambda_1, (controlled,)
};

/// The program of InverseController, in efforts over a scale of each. After the efforts come what
/// rows of contact forces lack to their limits, over a scale, too.
class EffortProgram {
 public:
  EffortProgram() = default;
  /// @param rows of H, those of all effectors. @param weights Q, as many. @param actuators how many
  ///   the controller has. @param forces what is asked of contacts.
  EffortProgram(std::vector<int> rows, VectorX weights, int actuators, ForceRows forces = {});

  /// What efforts are drawn to, the same in all programs until the next call.
  /// @param problem of the step. @param response of the robot to start from. @param pull see there.
  /// @param largest m, see ForceRows::begin().
  void begin(const step::StepProblem& problem, const step::Response& response,
             const EffortPull& pull, double largest);
  /// The objective. @param problem,response of the step. @param residual (rows,) motion without
  ///   efforts, less the one that is asked.
  void form(const step::StepProblem& problem, const step::Response& response,
            const VectorX& residual);
  /// After form(), within the limits. @param model of the robot. @param problem,response as there.
  ///   @param effort (controlled,) N, gets the solution, unless it failed.
  step::LawStatus solve(const sim::Model& model, const step::StepProblem& problem,
                        const step::Response& response, std::span<double> effort);
  /// The same within the response's guards, too. Failed where nothing is.
  /// @param problem,response,effort as there. @param tight whether those that are tight have no
  /// slack.
  step::LawStatus solve_guarded(const step::StepProblem& problem, const step::Response& response,
                                bool tight, std::span<double> effort);

  /// Of the last solution: the objective, half of the weighted squares of what is left included.
  double foreseen() const { return foreseen_; }
  /// (guards,) of the last solve_guarded().
  std::span<const double> guard_multipliers() const { return guard_multipliers_; }
  /// What the pull adds to the objective. @param effort (controlled,) N.
  double pull_value(std::span<const double> effort) const;
  /// How far efforts and motions are beyond the limits, the farthest, of a limit's size.
  /// @param problem of the step. @param motion (rows,) m. @param effort (controlled,) N.
  double excess(const step::StepProblem& problem, const VectorX& motion,
                std::span<const double> effort) const;

  const ForceRows& forces() const { return forces_; }
  /// Since forget(): the largest |W_ea^T Q W_ea|, in scaled efforts, J.
  double largest_asked() const { return largest_asked_; }
  /// @param value as largest_asked().
  void set_largest_asked(double value) { largest_asked_ = value; }

  /// Which limits of which actuators contradict each other in the last solve(); else empty.
  const std::string& conflict() const { return conflict_; }
  /// Whether a limit resists, by the multipliers of the last solve(). @param gap what is left of
  ///   the way to the targets, m.
  bool limit_holds(double gap) const;

  /// Forgets the active sets of the last solve().
  void reset();
  /// And its conflict.
  void forget();

 private:
  void form_scales(const step::StepProblem& problem, const step::Response& response);
  void form_rows(const step::StepProblem& problem, const step::Response& response);
  void regularise(const step::StepProblem& problem, const step::Response& response,
                  const EffortPull& pull);
  void form_limits(const step::StepProblem& problem, const step::Response& response,
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
  double slack_scale_ = 1.0;  // m, of what rows of forces lack
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
  qp::ElasticSolver elastic_{0, 0};            // for steps in which limits contradict each other
  VectorX bound_multiplier_, row_multiplier_;  // of the program
  std::string conflict_;
};

}  // namespace sinew::inverse
