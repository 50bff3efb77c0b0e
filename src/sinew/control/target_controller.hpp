/// @file
/// Interface of all controllers of effectors: targets, status, errors and observables.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sinew/control/controller_status.hpp"
#include "sinew/control/target_settings.hpp"
#include "sinew/core/types.hpp"
#include "sinew/run/observable.hpp"

namespace sinew::control {

class TargetController;

/// Settings of a controller of any type, from which make_controller() makes it.
struct ControllerSettings {
  TargetSettings targets;
  /// Makes it, with the settings that only its type has.
  std::function<std::unique_ptr<TargetController>(sim::Simulation&, TargetSettings)> make;
};

/// Base class of the controllers of effectors. It owns its actuators from construction to detach()
/// or destruction, and acts in each step of the simulation: it chooses efforts in the solution of
/// the step (law::Controller), or gives commands before it (run::Commander).
class TargetController {
 public:
  virtual ~TargetController() = default;
  TargetController(const TargetController&) = delete;
  TargetController& operator=(const TargetController&) = delete;

  virtual void detach() = 0;
  /// Replaces the target of a task. @param task index in the settings. @param target (3,) m or rad,
  /// or a path over the simulation's time. Throws Error: suspicious-unit, see check_target().
  void set_target(int task, Target target);

  const TargetSettings& settings() const { return settings_; }
  /// Settings that make another one like it, with the present targets.
  virtual ControllerSettings all_settings() const = 0;
  const sim::Simulation& simulation() const { return simulation_; }
  ControllerStatus status() const { return status_; }
  /// Efforts (actuators,) N after the last step, in the order of settings().actuators.
  virtual VectorX efforts() const;
  /// Present distance of a task's effector from its target, along the directions of the effector
  /// with nonzero weight; m or rad.
  double error(int task) const;
  /// The largest error() of all tasks.
  double error() const;
  /// The sensor by which a task's effector is measured, an index in sense::sensors_of(); -1: none.
  virtual int sensor(int task) const;
  /// The same error, by the last sample delivered; NaN without a sensor, and before the first
  /// sample.
  virtual double measured_error(int task) const;
  /// With limits-conflict: the limits that contradict each other. With holding: the sensors that
  /// are silent. Otherwise empty.
  virtual std::string conflict() const;

  /// Observables of its own, besides the targets, errors and status of all controllers; they stay
  /// the same.
  virtual const std::vector<run::Observable>& observables() const;
  /// Writes the values of observables(), one after the other.
  virtual void read(std::span<double>) const {}

 protected:
  /// @param simulation must outlive the controller. @param settings checked by check_settings(),
  ///   which throws.
  TargetController(sim::Simulation& simulation, TargetSettings settings);

  sim::Simulation& simulation_;
  TargetSettings settings_;
  ControllerStatus status_ = ControllerStatus::not_started;
};

/// Settings of a controller of a type, which has Settings of its own.
/// @param targets,own its settings.
template <class Controller>
ControllerSettings settings_for(TargetSettings targets, typename Controller::Settings own) {
  return {std::move(targets),
          [own = std::move(own)](sim::Simulation& simulation, TargetSettings present) {
            return std::make_unique<Controller>(simulation, std::move(present), own);
          }};
}

/// Makes a controller. @param simulation,settings as for the constructor of its type, which throws.
std::unique_ptr<TargetController> make_controller(sim::Simulation& simulation,
                                                  const ControllerSettings& settings);

}  // namespace sinew::control
