/// @file
/// One solution of a step's equation, over the whole time step or a part of it.
#pragma once

#include <cstddef>
#include <vector>

#include "sinew/law/step_problem.hpp"
#include "sinew/run/work_ledger.hpp"

namespace sinew {
class Error;
}

namespace sinew::run {
struct Run;
}

namespace sinew::step {

/// Common part of the step methods: begin, solve and end a solution of the step's equation.
class Substep {
 public:
  /// @param run must outlive it.
  explicit Substep(run::Run& run);

  /// Evaluates the commands for a part that ends at a time. @param end,time_step s.
  void read_commands(double end, double time_step);
  /// Stores the state in Run::before and begins the part. Call after read_commands().
  void begin(double time_step);
  /// Solves the part. If it fails with the choice of a controller and the caller cannot retry with
  /// smaller parts, the controller chooses a smaller change of its efforts. Throws Error, and what
  /// the watcher throws, after which the run is as before begin().
  /// @param time_step s, as for begin().
  /// @param divisible whether the caller can retry with smaller parts.
  void solve(double time_step, bool divisible = false);
  /// Updates velocities, actuators and the energy ledger. If a point landed in a BDF2 step and the
  /// energy grew, the step is first solved again with backward Euler; this throws as solve() does.
  /// @return error estimate, m.
  double end(double time_step);
  /// The same after a part that was solved as the first half of a midpoint step, whose motion was
  /// then doubled. @param time_step s, of the whole step.
  void end_as_midpoint(double time_step);

 private:
  void begin_world(double time_step);
  void hold_back(double time_step, const Error& failure);
  void solve_equation(double time_step, bool divisible);
  void solve_once(double time_step);
  void solve_afresh(double time_step);
  void repeat_afresh(double time_step);
  void begin_again(double time_step);
  bool may_start_afresh() const;
  void mark_stopped(double time_step);
  void mark_caught(double time_step);
  bool still_stops(std::size_t block, int row, double time_step) const;
  void mark_row(int row);
  bool marks_others() const;
  void spread_marks();
  double end_once(double time_step);
  void find_end_efforts(double time_step);
  void start_afresh();
  void end_zones();
  bool lands() const;
  bool has_gained() const;
  void limit_dissipation();
  void count(run::Quadrature quadrature, double time_step);

  run::Run& run_;
  std::vector<char> marks_;     // (bodies,) 1: stopped in this part, or connected to such a body
  bool divisible_ = false;      // see solve()
  bool lands_by_bdf2_ = false;  // whether points may land in this part, a BDF2 step with history
  double energy_before_ = 0.0;  // J, if lands_by_bdf2_: of the bodies at the start of the part
  bool held_before_ = false;    // a controller's choice, in earlier parts of the step
  int failures_ = 0;            // of this part with the choices of a controller
  bool holds_back_ = false;     // whether this part is made without a choice of the controller
  // Of the part before it is solved, if its formula reaches back or a controller chooses.
  std::vector<law::ActuatorBlock> actuators_;
};

}  // namespace sinew::step
