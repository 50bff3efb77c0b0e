/// @file
/// The actuators of a run: their commands, efforts and motions.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/model/actuator.hpp"

namespace sinew::law {
struct ActuatorBlock;
}

namespace sinew::model {
class Model;
}

namespace sinew::run {

struct State;

/// Converts commands to the actuator blocks of a step's problem, and reads efforts and motions from
/// its solution. Stores the state of the drives.
class Actuation {
 public:
  /// @param model must outlive it.
  explicit Actuation(const model::Model& model);

  /// (actuators,)
  const std::vector<model::ActuatorState>& states() const { return states_; }
  /// (actuators,) m or m^3, motions at the start of the step that was read last.
  std::span<const double> motions_before() const { return motions_before_; }
  /// State variables of an actuator's drive (see Drive); empty without one.
  std::span<const double> drive_state(int actuator) const;
  std::size_t drive_numbers() const { return drives_.size(); }

  /// Throws Error(actuator-owned) unless `by` owns the actuator (null: it has no owner).
  void command(int actuator, model::Command command, const void* by = nullptr);
  /// @param commands (actuators,) commands of actuators whose efforts a controller chooses take
  ///   effect on release; actuators commanded by an owner keep their commands.
  void set_commands(const std::vector<model::Command>& commands);
  /// @param owner of these actuators until release().
  /// @param actuators indices of Model::actuators().
  /// @param chosen whether the owner chooses their efforts; otherwise it gives commands.
  void own(const void* owner, std::span<const int> actuators, bool chosen = true);
  /// Releases the actuators of an owner. Those whose effort was chosen keep their present motion, a
  /// chamber its pressure; the others keep their commands.
  void release(const void* owner);

  /// Writes the blocks of a step: limits, commands and drives, from the state at its start.
  /// @param time s, the end of the step, at which commands are evaluated.
  /// @param time_step s; infinity removes the rate limits. @param blocks (actuators,).
  void form_blocks(double time, double time_step, std::span<law::ActuatorBlock> blocks) const;
  /// Reads efforts and motions from the solution of a step.
  /// @param delta,effort (rows,) at the end of the step. @param blocks (actuators,) of the step.
  void read(const VectorX& delta, std::span<const double> effort,
            std::span<const law::ActuatorBlock> blocks);
  /// Advances the state of the drives, also where a controller chose the effort. Call after read().
  void advance_drives(std::span<const law::ActuatorBlock> blocks);

  /// Resets the drives and the commands of actuators without an owner.
  void restart();
  void save(State& state) const;
  void load(const State& state);

 private:
  std::span<double> numbers_of(std::size_t actuator);
  void check_held(int actuator, const model::Command& command) const;

  const model::Model& model_;
  std::vector<model::ActuatorState> states_;
  std::vector<double> motions_before_;
  std::vector<double> drives_;  // state variables of all drives, at the start of the step
};

/// A closed interval.
struct Interval {
  double min, max;
};
/// [limits.min, limits.max], restricted to what `rate` allows from `now`. A value outside its
/// limits moves towards them at the highest rate.
/// @param limits of the value and its rate. @param now present value. @param time_step s.
Interval reachable(const model::Limits& limits, double now, double time_step);

/// Interpolates commands between the actuators' values at the start and the commands themselves.
/// @param blocks (actuators,) of a step. @param start (actuators,).
/// @param fraction 0 for the start, 1 for the commands.
void blend(std::span<law::ActuatorBlock> blocks, std::span<const model::ActuatorState> start,
           double fraction);

/// Whether any joint motor has a commanded motion and limits on its effort.
/// @param model with the motors. @param blocks (actuators,) of a step.
bool limits_motors(const model::Model& model, std::span<const law::ActuatorBlock> blocks);
/// Removes these limits. In statics, motors may be all that holds a chain of links. The torques of
/// an iteration say nothing about those of the equilibrium, and a motor at its limit would release
/// the chain. So the equilibrium is first sought without the limits, and accepted if they hold at
/// its end.
/// @param model with the motors. @param blocks (actuators,) of a step.
void lift_motor_limits(const model::Model& model, std::span<law::ActuatorBlock> blocks);
/// Whether the efforts of motors are within their limits. @param model with the motors.
/// @param blocks (actuators,), with limits. @param effort (rows,) N or Pa.
bool keeps_motor_limits(const model::Model& model, std::span<const law::ActuatorBlock> blocks,
                        std::span<const double> effort);

/// Holds the actuators of a controller at the efforts that it chose last.
/// @param blocks of a step. @param effort (rows,) N or Pa.
void hold_efforts(std::span<law::ActuatorBlock> blocks, std::span<const double> effort);
/// Commands the efforts that the controller chose last, within the present limits.
/// @param blocks of a step. @param effort (rows,) N or Pa.
void command_efforts(std::span<law::ActuatorBlock> blocks, std::span<const double> effort);

}  // namespace sinew::run
