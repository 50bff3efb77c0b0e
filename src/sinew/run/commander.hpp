/// @file
/// Commanders give commands to actuators before each step, as a computer beside a robot does.
#pragma once

#include "sinew/law/with_memory.hpp"

namespace sinew::run {

/// Gives commands to its actuators, which follow them according to their laws, limits and drives. A
/// law::Controller, in contrast, chooses efforts within the solution of a step.
class Commander : public law::WithMemory {
 public:
  /// Called before each step to call Simulation::command(). An exception propagates, and the step
  /// is not made.
  virtual void command() = 0;
  /// Called after a step that could not be solved with its commands, and that was made with those
  /// of the last step.
  virtual void hold_back() = 0;
};

}  // namespace sinew::run
