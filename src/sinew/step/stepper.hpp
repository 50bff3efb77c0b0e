/// @file
/// Time steps of a run.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sinew/model/actuator.hpp"
#include "sinew/run/state.hpp"
#include "sinew/step/event_stepper.hpp"
#include "sinew/step/substep.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::step {

/// Makes the time steps of a run: each as a whole, in smaller substeps if it fails or the
/// integrator's error requires it, or from one impact to the next.
class Stepper {
 public:
  /// @param run must outlive it.
  explicit Stepper(run::Run& run) : run_(run), substep_(run), events_(run) {}
  /// Advances the run by one time step and fills its report. See Simulation::step().
  void step();
  std::size_t bytes() const { return sizeof(double) * start_.size() + events_.bytes(); }

 private:
  // A part of a divided step, in which commands are interpolated towards those of the whole step.
  struct Part {
    double fraction = 1.0;                    // of the step that is done at the end of the part
    std::vector<model::ActuatorState> start;  // at the start of the step
    std::vector<double> goal;                 // (actuators,) commands at its end
  };

  void make();
  void make_or_hold_back();
  bool hold_back();
  void undo(bool opened_ledger);
  void step_in_parts();
  void step_as_it_is();
  double first_part() const;
  void go_on_in_parts(double length, double next);
  Part whole_step(double begin);
  void go_in_proportion();
  void step_adaptively();
  void step_by_events();
  double substep(double end, double time_step, bool divisible);
  bool cavitates() const;
  void judge();
  void watch_energy();

  run::Run& run_;
  run::State start_;      // of the whole step, if it is divided
  bool divided_ = false;  // whether the step is divided
  std::optional<Part> part_;
  std::vector<double> held_;  // (actuators,) efforts in place of a controller's choice; or empty
  Substep substep_;
  EventStepper events_;
};

}  // namespace sinew::step
