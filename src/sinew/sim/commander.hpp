/// @file
/// What tells actuators from step to step what to do, as a computer beside a robot does.
#pragma once

#include "sinew/step/with_memory.hpp"

namespace sinew::sim {

/// Its actuators obey its commands by their laws, within their limits and with their drives. A
/// step::Controller chooses efforts within the solution of a step instead.
class Commander : public step::WithMemory {
 public:
  /// Called before each step: time to call Simulation::command(). What it throws passes on, and the
  /// step is not made.
  virtual void command() = 0;
};

}  // namespace sinew::sim
