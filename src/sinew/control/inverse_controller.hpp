/// @file
/// Inverse control by quadratic programming: finds the efforts that take the effectors to their
/// targets.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sinew/control/effort_program.hpp"
#include "sinew/control/inverse_settings.hpp"
#include "sinew/control/step_damping.hpp"
#include "sinew/control/target_controller.hpp"
#include "sinew/core/types.hpp"
#include "sinew/law/certificate.hpp"
#include "sinew/law/controller.hpp"

namespace sinew::control {

/// Controller that chooses the efforts of its actuators by a quadratic program in each step. It
/// owns its actuators from construction to detach() or destruction. Let e be the rows of effectors,
/// a those of actuators, Q the weights and |x|_Q^2 = x^T Q x. The program is
///   min  1/2 |W_ea lambda + delta_e - target|_Q^2 + eps/2 |lambda - lambda_0|_R^2
///   s.t. limits on lambda, and on delta_a = delta_free + W_aa lambda, rates folded in,
/// with the requirements on contact forces (ForceRows), which come first. lambda_0 is the effort of
/// the previous step (Regularisation::change) or zero. R is W_aa with a millionth of its diagonal
/// added: cables on one path, which W_aa cannot distinguish, share their changes evenly.
/// StepDamping adds a term that keeps lambda near that of the previous step if the robot did not
/// respond as predicted. W and delta_free are those of law::Response: actuators that the
/// controller does not own obey their commands, and springs, gas, contacts and friction obey their
/// laws.
class InverseController : public TargetController, public law::Controller {
 public:
  using Settings = InverseSettings;

  /// @param simulation must outlive the controller. @param settings tasks and actuators.
  /// @param own contacts and options.
  /// Throws Error: no-effectors, no-actuators, actuator-owned, wrong-length (weights),
  /// out-of-range, duplicate-key (a contact twice), suspicious-unit.
  InverseController(sim::Simulation& simulation, TargetSettings settings, InverseSettings own = {});
  ~InverseController() override;

  /// Solves and advances the simulation by one step.
  ControllerStatus step();
  void detach() override;
  ControllerSettings all_settings() const override {
    return settings_for<InverseController>(settings_, own_);
  }

  /// The settings that only an inverse controller has.
  const InverseSettings& own_settings() const { return own_; }
  /// The efforts that it chose last.
  VectorX efforts() const override { return efforts_; }
  /// Violation of the requirement on a contact's forces, N, by the linearisation of the last step;
  /// NaN before the first step. @param task index in own_settings().contacts.
  double force_error(int task) const { return force_errors_.at(static_cast<std::size_t>(task)); }
  /// Certificate of the last step's linearisation, if own_settings().certify; none before the first
  /// step.
  const std::optional<law::Certificate>& certificate() const { return certificate_; }
  /// Error that remains by the linearisation of the last step, m or rad, over all tasks; NaN before
  /// the first step.
  double predicted_error() const { return predicted_error_; }
  std::string conflict() const override { return program_.conflict(); }

  void begin_choices(const law::StepProblem& problem, const law::Response& response) override;
  law::LawStatus choose(const law::StepProblem& problem, const law::Response& response,
                        law::Guards guards, std::span<double> effort) override;
  double foreseen() const override { return program_.foreseen(); }
  std::span<const double> guard_multipliers() const override {
    return program_.guard_multipliers();
  }
  Merit merit(const law::StepProblem& problem, const VectorX& motion, std::span<const double> own,
              std::span<const double> effort) const override;
  double negligible_gain() const override { return negligible_objective(); }
  void accept(const law::StepProblem& problem, const law::Response& response, const VectorX& motion,
              std::span<const double> own, std::span<const double> effort) override;
  bool certifies() const override { return own_.certify; }
  void take_certificate(const law::Certificate& certificate) override {
    certificate_ = certificate;
  }
  void begin_step(int failures) override;
  void hold_back(int failures) override;
  std::size_t memory_size() const override;
  void save_memory(std::span<double> memory) const override;
  void load_memory(std::span<const double> memory) override;
  void forget() override;

 private:
  void look_back(const law::StepProblem& problem, const law::Response& response);
  void review_choice(const law::StepProblem& problem, const law::Response& response);
  void review(StepDamping& damping, const law::Response& response, const VectorX& before) const;
  template <class Self, class Visitor>
  static void visit_memory(Self& self, Visitor&& visitor);
  void measure_gap(const law::StepProblem& problem);
  double objective(const VectorX& gap) const;
  double negligible_objective() const;
  void form_residual(const law::StepProblem& problem, const law::Response& response);
  double foresee(const law::StepProblem& problem, const law::Response& response,
                 const VectorX& motion);
  bool rate_binds(const law::StepProblem& problem, const law::Response& response,
                  const VectorX& motion, std::span<const double> effort) const;
  void measure_forces(const law::StepProblem& problem, const VectorX& motion,
                      std::span<const double> effort);
  bool forces_hold() const;
  double largest_step(const law::StepProblem& problem) const;
  ControllerStatus judge(const law::StepProblem& problem, const law::Response& response,
                         const VectorX& motion, std::span<const double> effort, double moved) const;

  InverseSettings own_;
  bool attached_ = false;

  std::vector<int> effector_rows_;  // rows of H, task by task
  std::vector<char> row_turns_;     // whether a row is an angle
  VectorX row_weights_;             // (effector rows,) Q
  VectorX residual_;                // delta_free_e - target, shortened to largest_step
  VectorX gap_;                     // (effector rows,) the target's delta minus delta
  StepDamping damping_;
  StepDamping inner_damping_;  // over the choices of one step
  VectorX last_choice_;        // (controlled,) efforts
  bool tried_ = false;         // whether the robot has followed it
  int failures_ = 0;           // of this step with its choices
  VectorX gap_linearised_;     // where it was linearised for that choice
  VectorX change_;             // (controlled,) of efforts by that choice
  VectorX expected_;           // (effector rows,) m, how the change was to move the effectors
  mutable VectorX without_;    // (effector rows,) gap without change_, in review()
  EffortProgram program_;
  VectorX efforts_;
  double predicted_error_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> force_errors_;  // (contacts,)
  std::optional<law::Certificate> certificate_;

  double time_ = -std::numeric_limits<double>::infinity();  // end of the present step, s
  std::vector<Vector3> asked_;                              // the targets at that time
  VectorX gap_before_;                                      // gap at the start of the step
  VectorX for_later_;  // the part of it that the step leaves to the next ones
  VectorX foreseen_;   // gap after the step, by the linearisation
  double surprise_ = std::numeric_limits<double>::infinity();  // error of the last prediction, m
  double came_ = std::numeric_limits<double>::infinity();      // motion in the last step, m
};

}  // namespace sinew::control
