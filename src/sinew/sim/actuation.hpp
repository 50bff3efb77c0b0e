/// @file
/// The actuators of a run: what they are told, and what they do.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/sim/actuator.hpp"

namespace sinew::step {
struct ActuatorBlock;
}

namespace sinew::sim {

class Model;
struct State;

/// From commands to the blocks of a step's problem, and from its solution to what actuators did;
/// with the numbers of their drives.
class Actuation {
 public:
  /// @param model outlives it.
  explicit Actuation(const Model& model);

  /// (actuators,)
  const std::vector<ActuatorState>& states() const { return states_; }
  /// (actuators,) m or m^3, before the motion that was read last.
  std::span<const double> motions_before() const { return motions_before_; }
  /// The numbers of an actuator's drive (see Drive); empty without one.
  std::span<const double> drive_state(int actuator) const;
  std::size_t drive_numbers() const { return drives_.size(); }

  /// Throws Error(actuator-owned) while a controller other than `by` has it.
  void command(int actuator, Command command, const void* by = nullptr);
  /// @param commands (actuators,) those of actuators whose efforts are chosen wait for their
  /// release; those that an owner commands keep their commands.
  void set_commands(const std::vector<Command>& commands);
  /// @param owner of these actuators until release(). @param actuators indices of
  /// Model::actuators(). @param chosen whether it chooses their efforts; else it commands them.
  void own(const void* owner, std::span<const int> actuators, bool chosen = true);
  /// They stay where they stand, or where they were told to be, until they are told otherwise.
  void release(const void* owner);

  /// What each may do in a step, from its state before. @param time s, the end of the step, at
  /// which commands are read. @param time_step s; infinity lifts the limits on rates. @param blocks
  /// (actuators,).
  void form_blocks(double time, double time_step, std::span<step::ActuatorBlock> blocks) const;
  /// What each did in it. @param delta,effort (rows,) at the end of the step. @param blocks of it.
  void read(const VectorX& delta, std::span<const double> effort,
            std::span<const step::ActuatorBlock> blocks);
  /// After read(): where each drive then stands, whoever chose its effort.
  void advance_drives(std::span<const step::ActuatorBlock> blocks);

  /// Commands of those that nobody owns, and drives, as at the start.
  void restart();
  void save(State& state) const;
  void load(const State& state);

 private:
  std::span<double> numbers_of(std::size_t actuator);

  const Model& model_;
  std::vector<ActuatorState> states_;
  std::vector<double> motions_before_;
  std::vector<double> drives_;  // numbers of all drives, at the start of the step
};

/// An interval of values.
struct Interval {
  double min, max;
};
/// [limits.min, limits.max] cut to what `rate` allows from `now`. A value that stands outside its
/// limits moves towards them as fast as it may.
/// @param limits of the value, and its rate. @param now where it is. @param time_step s.
Interval reachable(const Limits& limits, double now, double time_step);

/// Moves commands towards them from where the actuators were.
/// @param blocks (actuators,) of a step. @param start (actuators,). @param fraction of the way, 1
/// for the commands themselves.
void blend(std::span<step::ActuatorBlock> blocks, std::span<const ActuatorState> start,
           double fraction);

/// Whether motors of joints are told where to go, and may not do so whatever it takes.
/// @param model of them. @param blocks (actuators,) of a step.
bool limits_motors(const Model& model, std::span<const step::ActuatorBlock> blocks);
/// Lets them do so. In statics nothing else may hold a chain of links: while it is on its way, the
/// torques of an iteration say nothing about those of the equilibrium, and limits would let go of
/// the chain. So the way is made without them first, which counts where they are kept in the end.
/// @param model of them. @param blocks (actuators,) of a step.
void lift_motor_limits(const Model& model, std::span<step::ActuatorBlock> blocks);
/// Whether motors' efforts are within limits. @param model of them. @param blocks (actuators,),
/// with their limits. @param effort (rows,) N or Pa.
bool keeps_motor_limits(const Model& model, std::span<const step::ActuatorBlock> blocks,
                        std::span<const double> effort);

/// Holds owned actuators at the efforts that their controller chose last.
/// @param blocks of a step. @param effort (rows,) N or Pa.
void hold_efforts(std::span<step::ActuatorBlock> blocks, std::span<const double> effort);

}  // namespace sinew::sim
