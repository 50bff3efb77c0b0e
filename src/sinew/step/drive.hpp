/// @file
/// What stands between a command and an effort where that is more than a limit: a volume of gas, a
/// supply that lets only so much through, a spring. A drive relates effort and motion of its row by
/// a falling curve that is solved together with the robot, so that its stiffness does not limit the
/// time step.
#pragma once

#include <array>
#include <span>

#include "sinew/core/named_hash.hpp"

namespace sinew::step {

enum class CommandKind {
  effort,  ///< tension or force (N), pressure (Pa)
  motion,  ///< displacement (m), growth of volume (m^3)
  input,   ///< of the drive: see Drive::input(); of a motor, its velocity
};

/// The name of a number and its SI unit.
struct QuantityName {
  const char* name = "";
  const char* unit = "";
};

/// Immutable; the numbers of a run are the caller's.
class Drive {
 public:
  virtual ~Drive() = default;

  /// Numbers of its state that a drive may have.
  static constexpr std::size_t kMaxStates = 2;

  /// What a step asks; a value, so that a step's problem is one.
  struct Step {
    CommandKind kind = CommandKind::effort;
    double command = 0.0;
    double time_step = 0.0;      ///< s; infinity asks for what is reached in the long run
    double motion_before = 0.0;  ///< at the start of the step
    std::array<double, kMaxStates> state{};  ///< at the start of the step, state_size() of them
  };
  struct Response {
    double effort = 0.0;
    double slope = 0.0;  ///< d effort / d motion, <= 0
  };

  /// Numbers that a run keeps, <= kMaxStates.
  virtual int state_size() const = 0;
  /// Those of a robot at rest.
  virtual void rest(std::span<double> state) const = 0;
  /// What CommandKind::input commands.
  virtual QuantityName input() const = 0;
  /// Whether the drive shapes the effort under commands of this kind; else the actuator obeys them
  /// itself. A passive one, with a command or without, always does.
  virtual bool acts_on(CommandKind kind) const = 0;
  /// Whether a controller may choose the effort in its place.
  virtual bool controllable() const = 0;
  /// Effort at the end of a step that ends with `motion`.
  virtual Response respond(const Step& step, double motion) const = 0;
  /// The state at the end of a step that ended with `motion` and `effort`, whoever chose it.
  virtual void advance(const Step& step, double motion, double effort,
                       std::span<double> state) const = 0;
  /// Adds all that its curve depends on.
  virtual void add_to(ValueHash& hash) const = 0;
};

}  // namespace sinew::step
