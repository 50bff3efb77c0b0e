/// @file
/// Time steps of a run.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sinew/sim/actuator.hpp"
#include "sinew/sim/event_stepper.hpp"
#include "sinew/sim/state.hpp"

namespace sinew::sim {

struct Run;

/// Makes a step whole, in smaller ones where it fails or the integrator's error asks for them, or
/// from one impact to the next.
class Stepper {
 public:
  /// @param run outlives it.
  explicit Stepper(Run& run) : run_(run), events_(run) {}
  /// Advances the run by one time step, and reports. See Simulation::step().
  void step();
  std::size_t bytes() const { return sizeof(double) * start_.size() + events_.bytes(); }

 private:
  // Commands of a step that is made in parts go in proportion to where the whole step leads.
  struct Part {
    double fraction = 1.0;             // of the step, at the end of the part
    std::vector<ActuatorState> start;  // of the step
    std::vector<double> goal;          // (actuators,) commands at its end
  };

  void step_in_parts();
  double first_part() const;
  void go_on_in_parts(double length, double next);
  Part whole_step(double begin);
  void go_in_proportion();
  void step_adaptively();
  void step_by_events();
  double substep(double end, double time_step, bool divisible);
  bool is_balanced() const;
  void judge();
  void watch_energy();

  Run& run_;
  State start_;           // of the whole step, where that is made in parts
  bool divided_ = false;  // it is
  std::optional<Part> part_;
  EventStepper events_;
};

}  // namespace sinew::sim
