/// @file
/// Interface of all controllers of effectors: targets, status and errors.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "sinew/control/inverse_settings.hpp"
#include "sinew/control/inverse_status.hpp"
#include "sinew/core/types.hpp"
#include "sinew/law/certificate.hpp"

namespace sinew::control {

/// Base class of the controllers of effectors. It owns its actuators from construction to detach()
/// or destruction, and acts in each step of the simulation.
class TargetController {
 public:
  virtual ~TargetController() = default;
  TargetController(const TargetController&) = delete;
  TargetController& operator=(const TargetController&) = delete;

  virtual void detach() = 0;
  /// Replaces the target of a task. @param task index in the settings. @param target (3,) m or rad,
  /// or a path over the simulation's time. Throws Error: suspicious-unit, see check_target().
  void set_target(int task, Target target);

  const InverseSettings& settings() const { return settings_; }
  const sim::Simulation& simulation() const { return simulation_; }
  InverseStatus status() const { return status_; }
  /// Efforts (actuators,) N after the last step, in the order of settings().actuators.
  virtual VectorX efforts() const = 0;
  /// Present distance of a task's effector from its target, along the directions of the effector
  /// with nonzero weight; m or rad.
  double error(int task) const;
  /// The largest error() of all tasks.
  double error() const;
  /// The same error, by the last sample delivered; NaN without sensors, and before the first
  /// sample.
  virtual double measured_error(int task) const;
  /// Violation of the requirement on a contact's forces, N, by the linearisation of the last step;
  /// NaN before the first step. @param task index in settings().contacts.
  virtual double force_error(int task) const;
  /// Certificate of the last step's linearisation, if settings().certify; none before the first
  /// step.
  virtual const std::optional<law::Certificate>& certificate() const;
  /// Error that remains by the linearisation of the last step, m or rad, over all tasks; NaN before
  /// the first step.
  virtual double predicted_error() const;
  /// With limits-conflict: the limits that contradict each other. With holding: the sensors that
  /// are silent. Otherwise empty.
  virtual std::string conflict() const;

 protected:
  /// @param simulation must outlive the controller. @param settings checked by check_settings(),
  ///   which throws.
  TargetController(sim::Simulation& simulation, InverseSettings settings);

  sim::Simulation& simulation_;
  InverseSettings settings_;
  InverseStatus status_ = InverseStatus::not_started;
};

/// Makes a ClosedLoop if the settings have feedback, else an InverseController.
/// @param simulation,settings as for their constructors, which throw.
std::unique_ptr<TargetController> make_controller(sim::Simulation& simulation,
                                                  InverseSettings settings);

}  // namespace sinew::control
