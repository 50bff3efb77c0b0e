/// @file
/// What all controllers of effectors have in common: targets, status and errors.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "sinew/core/types.hpp"
#include "sinew/inverse/inverse_settings.hpp"
#include "sinew/inverse/inverse_status.hpp"
#include "sinew/step/certificate.hpp"

namespace sinew::inverse {

/// Owns its actuators from construction to detach() or destruction, and acts in each step of the
/// simulation.
class TargetController {
 public:
  virtual ~TargetController() = default;
  TargetController(const TargetController&) = delete;
  TargetController& operator=(const TargetController&) = delete;

  virtual void detach() = 0;
  /// Replaces a task's target. @param task position in the settings. @param target (3,) m or rad,
  ///   or a path over the simulation's time. Throws Error(suspicious-unit), see check_target().
  void set_target(int task, Target target);

  const InverseSettings& settings() const { return settings_; }
  const sim::Simulation& simulation() const { return simulation_; }
  InverseStatus status() const { return status_; }
  /// Efforts (actuators,) N after the last step, in the order of settings().actuators.
  virtual VectorX efforts() const = 0;
  /// Distance of a task's effector from its target now, along the effector's directions whose
  /// weight is not zero; m or rad.
  double error(int task) const;
  /// The largest error() of all tasks.
  double error() const;
  /// The same by the sample that was delivered last; NaN without sensors, and before the first.
  virtual double measured_error(int task) const;
  /// N: by how much the forces of a contact are beyond what is asked of them, by the last step's
  /// linearisation; NaN before a step. @param task position in settings().contacts.
  virtual double force_error(int task) const;
  /// With settings().certify, of the last step's linearisation; none before a step.
  virtual const std::optional<step::Certificate>& certificate() const;
  /// What the last step's linearisation left, m or rad, all tasks together; NaN before a step.
  virtual double predicted_error() const;
  /// With limits-conflict: which limits of which actuators contradict each other. With holding:
  /// which sensors are silent. Else empty.
  virtual std::string conflict() const;

 protected:
  /// @param simulation must outlive the controller. @param settings see check_settings(), which
  /// throws.
  TargetController(sim::Simulation& simulation, InverseSettings settings);

  sim::Simulation& simulation_;
  InverseSettings settings_;
  InverseStatus status_ = InverseStatus::not_started;
};

/// A ClosedLoop where the settings have feedback, else an InverseController.
/// @param simulation,settings as for these, which throw.
std::unique_ptr<TargetController> make_controller(sim::Simulation& simulation,
                                                  InverseSettings settings);

}  // namespace sinew::inverse
