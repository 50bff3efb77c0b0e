/// @file
/// Drives: devices between a command and an effort, such as a volume of gas, a supply of limited
/// flow, or a spring. A drive relates effort and motion of its row by a decreasing curve that is
/// solved together with the robot, so that its stiffness does not limit the time step.
#pragma once

#include <array>
#include <span>

#include "sinew/core/part_visitor.hpp"

namespace sinew::law {

/// The quantity that a command prescribes.
enum class CommandKind {
  effort,  ///< tension or force (N), pressure (Pa)
  motion,  ///< displacement (m), growth of volume (m^3)
  input,   ///< input of a drive, see Drive::input(); velocity of a motor
};

/// The name of a quantity and its SI unit.
struct QuantityName {
  const char* name = "";
  const char* unit = "";
};

/// A drive, which relates effort and motion of a row by a decreasing curve. Immutable; the caller
/// owns the state of a run.
class Drive {
 public:
  virtual ~Drive() = default;

  /// Maximum size of a drive's state.
  static constexpr std::size_t kMaxStates = 2;

  /// Arguments of a step; a value, so that a step problem is one, too.
  struct Step {
    CommandKind kind = CommandKind::effort;
    double command = 0.0;
    double time_step = 0.0;                  ///< s; infinity: the steady state
    double motion_before = 0.0;              ///< at the start of the step
    std::array<double, kMaxStates> state{};  ///< at the start of the step, state_size() numbers
  };
  /// A point of the curve and its tangent.
  struct Response {
    double effort = 0.0;
    double slope = 0.0;  ///< d effort / d motion, <= 0
  };

  /// Size of the state, <= kMaxStates.
  virtual int state_size() const = 0;
  /// Writes the state of a robot at rest.
  virtual void rest(std::span<double> state) const = 0;
  /// The quantity that CommandKind::input commands.
  virtual QuantityName input() const = 0;
  /// Whether the drive acts under commands of this kind; else the actuator obeys them directly. A
  /// passive drive always acts, with or without a command.
  virtual bool acts_on(CommandKind kind) const = 0;
  /// Whether a controller may choose the effort in place of the drive.
  virtual bool controllable() const = 0;
  /// Effort and slope at the end of a step that ends with `motion`.
  virtual Response respond(const Step& step, double motion) const = 0;
  /// State at the end of a step that ended with `motion` and `effort`, even if a controller chose
  /// them.
  virtual void advance(const Step& step, double motion, double effort,
                       std::span<double> state) const = 0;
  /// Visits all that its curve depends on.
  virtual void describe(PartVisitor& visitor) const = 0;
};

}  // namespace sinew::law
